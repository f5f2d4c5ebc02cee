# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera inside of a closed mirror, or on its surface, sees what Cycles shows there."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from mathutils import Vector
from scenes import placed_room

pytestmark = pytest.mark.usefixtures("gpu")
SIZE = (64, 48)
INSIDE = (0.5, -1.2, 2.3)
ON_SURFACE = (0.0, -2.0, 2.0)


def looked_out(place: tuple[float, float, float], with_glow: bool = True, near: float = 0.001) -> bpy.types.Object:
    """The ball with the eye at this place, and something in it that shines."""
    ball = placed_room.build()
    camera = bpy.data.objects["Eye"]
    camera.location = place
    camera.rotation_euler = (np.radians(80.0), 0.0, np.radians(-20.0))
    camera.data.lens, camera.data.clip_start = 20.0, near
    if with_glow:
        bpy.ops.mesh.primitive_cube_add(size=0.5)
        glow = placed_room.material("Glow", (0.0, 0.0, 0.0))
        inputs = glow.node_tree.nodes["Principled BSDF"].inputs
        inputs["Emission Color"].default_value, inputs["Emission Strength"].default_value = (1.0, 0.5, 0.1, 1.0), 1.0
        placed_room.placed_object((0.6, 0.8, 2.2), glow, "Glow")
    return ball


def rendered(ball: bpy.types.Object, method: str = "auto", samples: int = 4) -> Frame:
    scene, view = placed_room.read(ball, SIZE)
    frame = Renderer(scene, Settings(method=method, samples=samples, bounces=8)).render(view)
    assert np.isfinite(frame.color()).all()
    return frame


def cycles(light: str = "full") -> np.ndarray:
    scene = bpy.context.scene
    scene.cycles.max_bounces = scene.cycles.glossy_bounces = 8
    return render_reference(scene, bpy.context.view_layer, *SIZE, 16, light).pixels[..., :3]


@pytest.mark.parametrize("place", [INSIDE, (0.0, -1.99, 2.0)])
def test_the_inside_is_as_cycles_shows_it(place: tuple[float, float, float]) -> None:
    ball = looked_out(place)
    frame = rendered(ball)
    assert frame.choice is not None and frame.choice["method"] == "exact"
    assert not any("inside" in warning for warning in frame.warnings)
    ours, truth = frame.color()[..., :3], cycles()
    # (Of red, the shining block's; its edges and those of its many images may go either way.)
    assert truth[..., 0].mean() > 0.1
    assert (np.abs(ours - truth).max(axis=-1) > 0.15).mean() < 0.15
    assert abs(ours.mean() - truth.mean()) < 0.1 * truth.mean()


def test_no_light_gets_in() -> None:
    assert rendered(looked_out(INSIDE, with_glow=False)).color()[..., :3].max() < 1e-3
    assert cycles().max() < 1e-3


@pytest.mark.parametrize("at_vertex", [False, True])
def test_on_the_surface_it_looks_in(at_vertex: bool) -> None:
    """Lines of sight begin at the near end of the camera's range, past the surface."""
    ball = looked_out(ON_SURFACE, with_glow=False)
    if at_vertex:
        nearest = max(ball.data.vertices, key=lambda vertex: -vertex.co.y - abs(vertex.co.x) - abs(vertex.co.z))
        bpy.data.objects["Eye"].location = nearest.co + Vector((0.0, 0.0, 2.0))
    assert rendered(ball).color()[..., :3].max() < 1e-3
    assert cycles().max() < 1e-3


def test_on_the_surface_it_looks_out() -> None:
    ball = looked_out(ON_SURFACE, with_glow=False)
    bpy.data.objects["Eye"].rotation_euler = (np.radians(80.0), 0.0, np.radians(160.0))
    frame = rendered(ball)
    assert frame.choice is not None and "inside" not in str(frame.choice["why"])
    assert (np.abs(frame.color()[..., :3] - cycles("direct")).max(axis=-1) > 0.1).mean() < 0.05


@pytest.mark.parametrize("method", ["newton", "environment_cube", "bisector_screen"])
def test_methods_without_rays_say_that_they_cannot(method: str) -> None:
    frame = rendered(looked_out(INSIDE), method, samples=1)
    assert [text for text in frame.warnings if 'inside of "Mirror Ball"' in text and "Exact" in text]
