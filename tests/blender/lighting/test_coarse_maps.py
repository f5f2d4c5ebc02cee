# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow maps hold the whole scene: where a view is too close for their texels, rays take their place once it rests."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object, principled
from curvrefl.curvrefl_addon.demo.shapes import Shape, box
from curvrefl.curvrefl_addon.renderer.lighting.lighting import Lighting
from lighting.room import add_lamp, build_room, judge_room

pytestmark = pytest.mark.usefixtures("gpu")


def hedgehog(spines: int) -> Shape:
    """Thin triangles on the upper half of a ball of 1 m."""
    rng = np.random.default_rng(2)
    outward = rng.normal(size=(spines, 3))
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    outward[:, 2] = np.abs(outward[:, 2])
    side = np.cross(outward, rng.normal(size=(spines, 3)))
    side *= 0.02 / np.linalg.norm(side, axis=1)[:, None]
    tip = outward * 1.3 + rng.normal(size=(spines, 3)) * 0.1
    points = np.stack([0.5 * outward - side, 0.5 * outward + side, tip], axis=1).reshape(-1, 3)
    return Shape(points, tuple((3 * row, 3 * row + 1, 3 * row + 2) for row in range(spines)))


def close_to_a_hedgehog(light: str) -> None:
    """On a floor of 480 m, with boxes far away on it."""
    build_room(with_lamp=False)
    for name in ("cube", "gloss"):
        bpy.data.objects.remove(bpy.data.objects[name])
    bpy.data.objects["floor"].scale = (40.0, 40.0, 1.0)
    bpy.data.objects["mirror"].location = (2.6, 2.0, 1.0)
    add_object("hedgehog", hedgehog(1500), principled("spines", (0.5, 0.35, 0.2), roughness=0.9))
    for number in range(4):
        place = (120.0 * (-1) ** number, 60.0 * number, 4.0)
        add_object(f"far {number}", box((8.0, 8.0, 8.0)), principled("far", (0.4, 0.4, 0.4)), location=place)
    if light == "sun":
        add_lamp("SUN", (2.0, -3.0, 3.5), 3.0, angle=0.01)
    add_camera((0.0, -4.5, 2.0), (0.0, 0.0, 0.4), 40.0)


@pytest.mark.parametrize("light", ["sun", "world"])
def test_fine_shadows_in_a_wide_scene_are_those_of_cycles(light: str, monkeypatch: pytest.MonkeyPatch) -> None:
    close_to_a_hedgehog(light)
    judged = judge_room(method="auto")
    assert judged.share_off < 0.02
    with monkeypatch.context() as change:
        change.setattr(Lighting, "too_coarse", lambda *_: (False, False))
        assert judge_room(method="auto").share_off > 0.02
