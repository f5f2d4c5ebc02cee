# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What lamps light is clamped where mirrors show it, as Cycles clamps light that has bounced, and not seen directly."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.report.images import load_exr
from lighting.room import HEIGHT, WIDTH, add_lamp, build_room, our_room

pytestmark = pytest.mark.usefixtures("gpu")
MOST = 10.0


def bright_room(roughness: float = 0.0) -> None:
    """A floor that sends back more than MOST under a hard sun, nothing else that shines; a clamp of MOST."""
    scene = build_room(with_lamp=False)
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    chrome = bpy.data.materials["chrome"].node_tree.nodes["Principled BSDF"]
    chrome.inputs["Roughness"].default_value = roughness
    add_lamp("SUN", (1.0, -2.0, 4.0), 200.0, angle=0.0)
    scene.cycles.sample_clamp_indirect = MOST


def ours(clamp: float, samples: int = 1) -> np.ndarray:
    """(HEIGHT, WIDTH, 3) as the file says, but for this clamp."""
    bpy.context.scene.cycles.sample_clamp_indirect = clamp
    return our_room(method="auto", samples=samples)[0].astype(float)


def cycles(path: Path, samples: int) -> np.ndarray:
    """The same as F12 has it."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.sample_clamp_indirect = samples, MOST
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return load_exr(path)[..., :3]


def test_mirrors_show_no_more_than_the_clamp_of_what_lamps_light() -> None:
    bright_room()
    free, clamped = ours(0.0), ours(MOST)
    changed = (free != clamped).any(axis=-1)
    # The mirror's part that shows the floor. (Each pixel is one sample, so that it is at the clamp or as it was.)
    assert 0.02 < changed.mean() < 0.3
    assert clamped[changed].mean(axis=-1) == pytest.approx(MOST, rel=1e-4)
    assert free[changed].mean(axis=-1).min() > MOST
    # What is seen directly is brighter, and stays so.
    assert (clamped[~changed].mean(axis=-1) > 2.0 * MOST).mean() > 0.1


@pytest.mark.parametrize("roughness", [0.0, 0.3])
def test_it_is_as_bright_as_in_cycles(roughness: float, tmp_path: Path) -> None:
    bright_room(roughness)
    free, clamped = ours(0.0, 64), ours(MOST, 64)
    # (The ball stands in the middle.)
    in_mirror = np.zeros((HEIGHT, WIDTH), bool)
    in_mirror[26:46, 38:58] = True
    theirs = cycles(tmp_path / "cycles.exr", 64)
    assert clamped[in_mirror].mean() == pytest.approx(theirs[in_mirror].mean(), rel=0.03)
    assert free[in_mirror].mean() > 1.1 * theirs[in_mirror].mean()
