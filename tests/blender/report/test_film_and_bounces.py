# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Transparent film and mirrors that see themselves are in our pictures what they are in Cycles'."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.report.compare import Comparison, compare_open_scene
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.report.direct_light import in_direct_light, mirrors_met
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_scene
from curvrefl.curvrefl_addon.settings_table import Settings
from scenes.file_settings.blurred_stage import build_blurred_stage, slide

pytestmark = pytest.mark.usefixtures("gpu")

WIDTH, HEIGHT = 64, 48


@pytest.mark.parametrize("method", ["exact", "secant_star", "environment_cube"])
def test_a_transparent_film_has_no_world_but_mirrors_do(method: str) -> None:
    scene = build_blurred_stage()
    scene.render.film_transparent = True
    if method == "exact":
        # A lamp that the camera sees adds light to what stays clear.
        lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT"))
        lamp.location, lamp.data.energy, lamp.data.shadow_soft_size = (1.6, 3.0, 1.2), 20.0, 0.5
        lamp.visible_camera = True
        scene.collection.objects.link(lamp)
        bpy.context.view_layer.update()
    layer = bpy.context.view_layer
    expected = render_reference(scene, layer, WIDTH, HEIGHT, 64).pixels
    arrays, view = read_render_scene(scene, layer, ["ball"], WIDTH, HEIGHT)
    renderer = Renderer(arrays, Settings(method=method, samples=16))
    opaque = renderer.render(view)
    on_ball, opaque_pixels = opaque.mask() > 0, opaque.color()
    renderer.configure(replace(renderer.settings, film_transparent=True))
    found = renderer.render(view).color()
    renderer.free()
    assert np.abs(found[..., 3] - expected[..., 3]).mean() < 0.005
    assert found[..., 3].min() == 0.0
    assert (found[found[..., 3] == 0.0].max() > 0.0) == (method == "exact")
    # On whole pixels of the mirror, the sky that it shows too, nothing has changed.
    whole = on_ball & (found[..., 3] > 0.999)
    assert whole.sum() > 100 and np.abs(found - opaque_pixels)[whole].max() < 1e-5
    if method == "exact":
        assert np.abs(found - expected).mean() < 0.01


def build_bowl() -> bpy.types.Scene:
    """The stage with an open bowl in place of the ball, looked into."""
    scene = build_blurred_stage()
    bowl = bpy.data.objects["ball"]
    kept = [vertex.co.z < 0.01 for vertex in bowl.data.vertices]
    mesh = bpy.data.meshes.new("bowl")
    number = np.cumsum(kept) - 1
    faces = [
        [int(number[i]) for i in face.vertices] for face in bowl.data.polygons if all(kept[i] for i in face.vertices)
    ]
    mesh.from_pydata([vertex.co[:] for vertex in bowl.data.vertices if kept[vertex.index]], [], faces)
    mesh.shade_smooth()
    mesh.materials.append(bowl.data.materials[0])
    bowl.data = mesh
    bowl.rotation_euler.x = np.radians(70.0)
    bpy.context.view_layer.update()
    return scene


def test_a_bowl_is_followed_in_itself_on_both_sides(tmp_path: Path) -> None:
    scene = build_bowl()
    layer = bpy.context.view_layer
    arrays, _ = read_render_scene(scene, layer, ["ball"], WIDTH, HEIGHT)
    assert mirrors_met(arrays, 4) == 4
    once = render_reference(scene, layer, WIDTH, HEIGHT, 32).pixels[..., :3]
    often = render_reference(scene, layer, WIDTH, HEIGHT, 32, bounces=4).pixels[..., :3]
    # With one bounce a bowl in a bowl is black.
    assert (once.max(axis=-1) < 0.02).sum() > 3 * (often.max(axis=-1) < 0.02).sum() + 50
    flips = {}
    for bounces in (1, 4):
        settings = Settings(bounces=bounces, samples=8)
        comparison = Comparison(("exact",), WIDTH, HEIGHT, 32, peers=(), settings=settings)
        report = compare_open_scene(scene, layer, ["ball"], comparison, tmp_path / str(bounces))
        flips[bounces] = report["methods"]["exact"]["image"]["flip"]
    assert flips[4] < 0.06, flips


def test_a_ball_alone_is_followed_once() -> None:
    scene = build_blurred_stage()
    layer = bpy.context.view_layer
    assert mirrors_met(read_render_scene(scene, layer, ["ball"], 8, 8)[0], 4) == 1
    assert mirrors_met(read_render_scene(scene, layer, ["ball", "cube 0"], 8, 8)[0], 4) == 4


@pytest.mark.parametrize("most", [0, 12])
def test_direct_light_goes_through_glass_as_far_as_the_file_allows_on_both_sides(most: int) -> None:
    scene = build_blurred_stage()
    glass = bpy.data.objects["cube 0"]
    glass.location, glass.scale = (-1.0, -2.6, 0.2), (2.5, 2.5, 2.5)
    shader = glass.data.materials[0].node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    shader.inputs["Transmission Weight"].default_value, shader.inputs["Emission Strength"].default_value = 1.0, 0.0
    scene.cycles.transmission_bounces, scene.cycles.max_bounces = most, 12
    bpy.context.view_layer.update()
    layer = bpy.context.view_layer
    expected = render_reference(scene, layer, WIDTH, HEIGHT, 64).pixels[..., :3]
    arrays, view = read_render_scene(scene, layer, ["ball"], WIDTH, HEIGHT)
    renderer = Renderer(in_direct_light(arrays), Settings(method="exact", samples=16, bounces=1))
    frame = renderer.render(view)
    found = frame.color()[..., :3]
    (number,) = [one.object_id for one in arrays.instances if one.object_name == "cube 0"]
    behind = frame.surfaces["seen_position"][..., 3] == number
    renderer.free()
    assert behind.sum() > 300
    assert (expected[behind].mean() > 0.1) == (most > 0)
    assert np.abs(found - expected)[behind].mean() < 0.03


def test_comparisons_are_blurred_on_both_sides(tmp_path: Path) -> None:
    scene = build_blurred_stage()
    scene.camera.data.dof.use_dof = True
    slide("cube 0", 0, -2.8, -0.4)
    scene.render.use_motion_blur = True
    comparison = Comparison(("exact", "secant_star"), WIDTH, HEIGHT, 256, peers=(), settings=Settings(samples=2))
    report = compare_open_scene(scene, bpy.context.view_layer, ["ball"], comparison, tmp_path / "blurred")
    for method, entry in report["methods"].items():
        assert entry["image"]["flip"] < 0.05, method
        # Geometry is that of the frame itself, through the middle of the lens.
        assert entry["geometry"]["angle_deg"]["median"] < 0.05, method
    assert any("16 sub-frames" in warning for warning in report["warnings"])
    assert (scene.frame_current, scene.frame_subframe, scene.render.use_motion_blur) == (1, 0.0, True)
    assert scene.camera.data.dof.use_dof
