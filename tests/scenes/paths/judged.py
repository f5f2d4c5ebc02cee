# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of scenes of paths by Cycles, kept in build/paths for each state of a scene, and ours beside them."""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from awkward.attempt import source_of
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference, use_cycles, use_still_output
from curvrefl.curvrefl_addon.report.geometry_reference import render_geometry
from curvrefl.curvrefl_addon.report.metrics import flip_in_mask
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_moments
from curvrefl.curvrefl_addon.scene.opened.temporary_settings import temporary_settings
from rendered import channels

from .registry import PathScene
from .stage import MOST_BOUNCES

CACHE = Path(__file__).resolve().parents[3] / "build" / "paths"
SEEDS = (11, 12, 13)
"""Of the two references, and of Cycles as a peer"""
PEER_SAMPLES = (16, 64)


@dataclass(frozen=True)
class References:
    """Pictures (h, w, 4) scene-linear, row 0 at the bottom."""

    first: np.ndarray
    second: np.ndarray
    peers: dict[int, np.ndarray]
    """By their samples: Cycles with yet another seed"""
    mask: np.ndarray
    """(h, w) whether the pixel's center shows what is judged"""

    @property
    def truth(self) -> np.ndarray:
        """Both references together."""
        return 0.5 * (self.first + self.second)

    @property
    def noise(self) -> float:
        """FLIP that the truth itself has from its noise: two halves differ by twice that of their mean."""
        return 0.5 * self.flip(self.first, self.second)

    def flip(self, picture: np.ndarray, truth: np.ndarray | None = None) -> float:
        found = flip_in_mask(picture, self.truth if truth is None else truth, self.mask)
        assert found is not None, "no pixel is judged"
        return found

    def color_error(self, picture: np.ndarray, truth: np.ndarray | None = None) -> float:
        """The largest relative error of the mean color over the mask, of the three channels; signed."""
        right = (self.truth if truth is None else truth)[self.mask][:, :3].mean(0, dtype=np.float64)
        error = picture[self.mask][:, :3].mean(0, dtype=np.float64) / np.maximum(right, 1e-6) - 1.0
        return float(error[np.abs(error).argmax()])


@dataclass(frozen=True)
class Opened:
    """An open scene as our renderer reads it."""

    arrays: SceneArrays
    view: View

    def picture(self, samples: int, **settings: Any) -> tuple[np.ndarray, tuple[str, ...]]:
        """(h, w, 4) scene-linear by rays, and what was warned of."""
        values = {"method": "exact", "bounces": MOST_BOUNCES} | settings
        renderer = Renderer(self.arrays, Settings(samples=samples, **values))
        try:
            frame = renderer.render(self.view)
            return frame.color(), frame.warnings
        finally:
            renderer.free()


def open_scene(scene: PathScene) -> Opened:
    """Builds it and reads it as a render does."""
    scene.build()
    return read_open(scene.mirrors)


def read_open(mirrors: tuple[str, ...]) -> Opened:
    """The scene that is open."""
    opened: Any = bpy.context.scene
    layer: Any = bpy.context.view_layer
    still, _, _ = read_render_moments(opened, layer, mirrors, *size_of(opened), 16)
    return Opened(still.scene, still.view)


def size_of(scene: Any) -> tuple[int, int]:
    return scene.render.resolution_x, scene.render.resolution_y


def references(scene: PathScene) -> References:
    """Of a scene that is open (`open_scene`)."""
    said = "\n".join(
        (bpy.app.version_string, _source(scene.build), repr((scene.judged, scene.samples, SEEDS, scene.layered)))
    )
    path = CACHE / f"{scene.name}-{hashlib.sha256(said.encode()).hexdigest()[:16]}.npz"
    shoot = layered_picture if scene.layered else cycles_picture
    if not path.is_file():
        CACHE.mkdir(parents=True, exist_ok=True)
        pictures = {
            "first": shoot(scene.samples, SEEDS[0]),
            "second": shoot(scene.samples, SEEDS[1]),
            "mask": judged_pixels(scene.judged),
        }
        for samples in PEER_SAMPLES:
            if samples <= scene.samples // 4:
                pictures[f"peer{samples}"] = shoot(samples, SEEDS[2])
        np.savez_compressed(path, allow_pickle=False, **pictures)
    with np.load(path) as kept:
        peers = {samples: kept[f"peer{samples}"] for samples in PEER_SAMPLES if f"peer{samples}" in kept}
        return References(kept["first"], kept["second"], peers, kept["mask"])


def cycles_picture(samples: int, seed: int) -> np.ndarray:
    """(h, w, 4) of the open scene by its own settings."""
    opened: Any = bpy.context.scene
    opened.cycles.seed = seed
    return render_reference(opened, bpy.context.view_layer, *size_of(opened), samples, "full").pixels


def layered_picture(samples: int, seed: int) -> np.ndarray:
    """The same of a convex object with a rough layer over a matt base.

    Cycles chooses a lobe for each ray but weighs it by all lobes, and with no diffuse bounces it ends those that the
    base chose: part of what the layer reflects is lost then, and part of the light is the base's indirect. So the rays
    go on once, whichever lobe chose them, and the base's indirect light is taken away by its pass.
    """
    opened: Any = bpy.context.scene
    layer: Any = bpy.context.view_layer
    with temporary_settings() as changes, tempfile.TemporaryDirectory() as folder:
        use_still_output(changes, opened, *size_of(opened))
        use_cycles(changes, opened, layer, samples, "full")
        changes.set(opened.cycles, seed=seed, max_bounces=1, diffuse_bounces=1)
        changes.set(layer, use_pass_diffuse_indirect=True, use_pass_diffuse_color=True)
        changes.set(opened.render.image_settings, media_type="MULTI_LAYER_IMAGE", file_format="OPEN_EXR_MULTILAYER")
        changes.set(opened.render, filepath=str(Path(folder) / "still.exr"))
        bpy.ops.render.render(write_still=True)
        found = channels(Path(folder) / "still.exr")
    indirect, color, combined = (_of_pass(found, name) for name in ("Diffuse Indirect", "Diffuse Color", "Combined"))
    picture = np.ones((*combined.shape[:2], 4), np.float32)
    picture[..., :3] = (combined - indirect * color)[::-1]
    return picture


def _of_pass(found: dict[str, np.ndarray], name: str) -> np.ndarray:
    """(h, w, 3) of a pass by the end of its channels' names."""
    return np.stack([next(found[key] for key in found if key.endswith(f".{name}.{part}")) for part in "RGB"], -1)


def judged_pixels(names: tuple[str, ...]) -> np.ndarray:
    """(h, w) whether the pixel's center shows one of these objects."""
    return judged_numbers(names) > 0


def judged_numbers(names: tuple[str, ...]) -> np.ndarray:
    """(h, w) which of these objects the pixel's center shows, from 1; 0 none."""
    opened: Any = bpy.context.scene
    ids = {name: number for number, name in enumerate(names, 1)}
    return render_geometry(opened, bpy.context.view_layer, *size_of(opened), ids, list(ids.values())).mask


def inner(here: np.ndarray) -> np.ndarray:
    """(h, w) pixels whose neighbors are all in the mask, too: no edge is mixed into them."""
    wide = np.pad(here, 1)
    height, width = here.shape
    return np.all([wide[y : y + height, x : x + width] for y in range(3) for x in range(3)], axis=0)


def _source(build: Callable[[], None]) -> str:
    """Of a builder, with what it is given where it is one of a row."""
    if not isinstance(build, partial):
        return source_of(build)
    functions = [build.func, *(value for value in build.args if callable(value))]
    numbers = [repr(value) for value in build.args if not callable(value)]
    return "\n".join([*(source_of(function) for function in functions), *numbers])
