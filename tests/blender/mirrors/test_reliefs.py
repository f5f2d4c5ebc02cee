# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Normal maps and bumps of mirrors: closed forms on a plane, Cycles on a ball."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from extraction import add, add_square, empty_scene, extracted, link

pytestmark = pytest.mark.usefixtures("gpu")

WIDTH, HEIGHT = 96, 72
TILT = np.radians(8.0)


def image(name: str, pixels: np.ndarray) -> bpy.types.Image:
    """Of float (h, w, 3) data."""
    height, width = pixels.shape[:2]
    made = bpy.data.images.new(name, width, height, float_buffer=True, is_data=True)
    made.pixels.foreach_set(np.dstack([pixels, np.ones((height, width))]).astype(np.float32).ravel())
    return made


def polished(obj: bpy.types.Object) -> Any:
    """Give it a chrome material; returns the shader node."""
    material = bpy.data.materials.new("chrome")
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 1.0, 0.0
    shader.inputs["Base Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    obj.data.materials.append(material)
    return shader


def plug(shader: Any, kind: str, socket: str, picture: bpy.types.Image | None, **values: Any) -> Any:
    """A Normal Map or Bump node with an image before the shader's normal; `values` of its inputs."""
    tree = shader.id_data
    node = tree.nodes.new(kind)
    for name, value in values.items():
        node.inputs[name].default_value = value
    if picture is not None:
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = picture
        tree.links.new(texture.outputs["Color"], node.inputs[socket])
    tree.links.new(node.outputs["Normal"], shader.inputs["Normal"])
    return node


def camera_at(place: tuple[float, float, float]) -> None:
    """Looks at the origin."""
    from mathutils import Vector

    camera = link(bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera")))
    camera.location = place
    camera.rotation_euler = (-Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = camera
    bpy.context.view_layer.update()


def frame_of(mirror: bpy.types.Object, method: str = "exact", samples: int = 1) -> Frame:
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    view = view_of_camera(scene, scene.camera, WIDTH, HEIGHT)
    return Renderer(extracted(mirror), Settings(method=method, samples=samples)).render(view)


def normals(frame: Frame) -> np.ndarray:
    """(n, 3), on the mirror."""
    return frame.surfaces["seen_normal"][..., :3][frame.mask() > 0]


def above_a_plane() -> tuple[bpy.types.Object, Any]:
    """A square mirror of 2 m seen from above, and a cube over it; its shader too."""
    empty_scene()
    mirror = add_square("mirror")
    add("cube").location = (0.0, 0.0, 30.0)
    camera_at((0.0, -0.5, 4.0))
    return mirror, polished(mirror)


def of_strength(tilted: np.ndarray, strength: float) -> np.ndarray:
    bent = np.array([strength * tilted[0], strength * tilted[1], 1.0 + min(strength, 1.0) * (tilted[2] - 1.0)])
    return bent / np.linalg.norm(bent)


@pytest.mark.parametrize("strength", [0.0, 0.5, 1.0, 2.0])
@pytest.mark.parametrize("turn", [0.0, 70.0, 200.0])
def test_constant_normal_map_tilts_the_mirror(strength: float, turn: float) -> None:
    """Towards the tangent, which goes with u."""
    mirror, shader = above_a_plane()
    tilted = np.array([np.sin(TILT), 0.5 * np.sin(TILT), 0.0])
    tilted[2] = np.sqrt(1.0 - tilted @ tilted)
    plug(shader, "ShaderNodeNormalMap", "Color", None, Color=(*(0.5 + 0.5 * tilted), 1.0), Strength=strength)
    mirror.rotation_euler.z = np.radians(turn)
    found = normals(frame_of(mirror))
    x, y, z = of_strength(tilted, strength)
    cosine, sine = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    assert len(found) > 500
    assert np.abs(found - [cosine * x - sine * y, sine * x + cosine * y, z]).max() < 1e-3


def test_mirrored_uv_turns_the_tangent_alone() -> None:
    mirror, shader = above_a_plane()
    mirror.data.uv_layers[0].uv.foreach_set("vector", [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
    tilted = np.array([np.sin(TILT) * 0.8, np.sin(TILT) * 0.6, np.cos(TILT)])
    plug(shader, "ShaderNodeNormalMap", "Color", None, Color=(*(0.5 + 0.5 * tilted), 1.0))
    assert np.abs(normals(frame_of(mirror)) - tilted * [-1.0, 1.0, 1.0]).max() < 1e-3


@pytest.mark.parametrize(("distance", "strength", "invert"), [(0.1, 1.0, False), (0.2, 0.5, False), (0.1, 1.0, True)])
def test_heights_that_rise_evenly_tilt_the_mirror(distance: float, strength: float, invert: bool) -> None:
    """By their slope: `distance` over the 2 m of the square, along u."""
    mirror, shader = above_a_plane()
    texels = 64
    ramp = np.broadcast_to(((np.arange(texels) + 0.5) / texels)[None, :, None], (4, texels, 3))
    node = plug(shader, "ShaderNodeBump", "Height", image("ramp", ramp), Distance=distance, Strength=strength)
    node.invert = invert
    slope = distance / 2.0 * (-1.0 if invert else 1.0)
    full = np.array([-slope, 0.0, 1.0]) / np.hypot(slope, 1.0)
    expected = (1.0 - strength) * np.array([0.0, 0.0, 1.0]) + strength * full
    expected /= np.linalg.norm(expected)
    frame = frame_of(mirror)
    inside = np.abs(frame.surfaces["seen_position"][..., 0][frame.mask() > 0]) < 0.95
    # (the image is repeated: its border is a step)
    found = normals(frame)[inside]
    assert len(found) > 500
    assert np.abs(np.median(found, axis=0) - expected).max() < 1e-3
    assert np.abs(found - expected).max() < 5e-3, "half floats of the heights"


def ripples(strength: float, texels: int = 128) -> np.ndarray:
    """A normal map of waves along u and v."""
    wave = 2.0 * np.pi * 4.0 * (np.arange(texels) + 0.5) / texels
    x, y = np.meshgrid(strength * np.sin(wave), strength * np.cos(wave))
    bent = np.dstack([x, y, np.ones_like(x)])
    return 0.5 + 0.5 * bent / np.linalg.norm(bent, axis=2, keepdims=True)


def heights(texels: int = 128) -> np.ndarray:
    """Waves along u and v, 0..1."""
    wave = 2.0 * np.pi * 4.0 * (np.arange(texels) + 0.5) / texels
    height = 0.5 + 0.25 * (np.sin(wave)[None, :] + np.cos(wave)[:, None])
    return np.repeat(height[..., None], 3, axis=2)


def with_normal_map(shader: Any) -> None:
    plug(shader, "ShaderNodeNormalMap", "Color", image("ripples", ripples(0.15)))


def with_bump(shader: Any) -> None:
    plug(shader, "ShaderNodeBump", "Height", image("heights", heights()), Distance=0.04)


def turned(bend: Callable[[Any], None]) -> Callable[[Any], None]:
    """With its image turned and stretched by a Mapping node."""

    def bend_turned(shader: Any) -> None:
        bend(shader)
        tree = shader.id_data
        mapping: Any = tree.nodes.new("ShaderNodeMapping")
        mapping.inputs["Rotation"].default_value = (0.0, 0.0, 0.6)
        mapping.inputs["Scale"].default_value = (1.3, 0.7, 1.0)
        place = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(place.outputs["UV"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs["Vector"], tree.nodes["Image Texture"].inputs["Vector"])

    return bend_turned


@pytest.mark.parametrize("bend", [with_normal_map, with_bump, turned(with_normal_map), turned(with_bump)])
def test_picture_is_that_of_cycles(bend: Callable[[Any], None]) -> None:
    """A rippled ball among bright blocks: far nearer to Cycles than the smooth ball is."""
    scene = empty_scene()
    scene.cycles.diffuse_bounces = 0
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.1, 0.2, 0.4, 1.0)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48)
    mirror = bpy.context.object
    bpy.ops.object.shade_smooth()
    shader = polished(mirror)
    for number, place in enumerate([(-3, -3, 0), (3, -3, 1), (0, -4, 3), (0, -3, -3), (-4, 0, 2), (4, 0, -2)]):
        block = add(f"block {number}")
        block.location = place
        glow = bpy.data.materials.new(f"glow {number}")
        surface = glow.node_tree.nodes["Principled BSDF"]
        surface.inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
        surface.inputs["Specular IOR Level"].default_value = 0.0
        surface.inputs["Emission Color"].default_value = (*np.roll([0.9, 0.5, 0.1], number), 1.0)
        surface.inputs["Emission Strength"].default_value = 1.0
        block.data.materials.append(glow)
    camera_at((0.0, -8.0, 0.5))
    scene.camera.data.lens = 90.0
    smooth = frame_of(mirror, samples=16).color()[..., :3]
    bend(shader)
    frame = frame_of(mirror, samples=16)
    assert not [warning for warning in frame.warnings if "Bumps" in warning or "Normal" in warning]
    reference = render_reference(scene, bpy.context.view_layer, WIDTH, HEIGHT, 64).pixels[..., :3]
    mask = frame.mask() > 0
    assert mask.sum() > 1000
    ours = np.abs(frame.color()[..., :3] - reference)[mask].mean()
    without = np.abs(smooth - reference)[mask].mean()
    assert ours < 0.2 * without
    assert ours < 0.02


def test_vertex_methods_say_that_they_leave_bumps_out() -> None:
    empty_scene()
    bpy.ops.mesh.primitive_uv_sphere_add()
    mirror = bpy.context.object
    mirror.name = "Ball"
    with_bump(polished(mirror))
    scenery = add_square("floor", 8.0)
    scenery.location.z = -2.0
    with_bump(polished(scenery))
    camera_at((0.0, -8.0, 0.5))
    said = frame_of(mirror, "secant_star").warnings
    assert any(line.startswith('Bumps of mirror "Ball" are left out: choose Automatic') for line in said)
    assert not any("floor" in line and "umps" in line for line in said)
    assert not any("Ball" in line for line in frame_of(mirror, "exact").warnings)
    assert not any("Ball" in line for line in frame_of(mirror, "environment_cube").warnings)


def test_a_normal_map_in_object_space_turns_with_the_object() -> None:
    mirror, shader = above_a_plane()
    tilted = np.array([np.sin(TILT), 0.0, np.cos(TILT)])
    node = plug(shader, "ShaderNodeNormalMap", "Color", None, Color=(*(0.5 + 0.5 * tilted), 1.0))
    node.space = "OBJECT"
    mirror.rotation_euler.z = np.radians(90.0)
    frame = frame_of(mirror)
    assert not frame.warnings
    assert np.abs(normals(frame) - [0.0, np.sin(TILT), np.cos(TILT)]).max() < 1e-3


def on_named_map(shader: Any, name: str) -> None:
    """What the image of `shader`'s bumps is on."""
    tree = shader.id_data
    place: Any = tree.nodes.new("ShaderNodeUVMap")
    place.uv_map = name
    tree.links.new(place.outputs["UV"], tree.nodes["Image Texture"].inputs["Vector"])


@pytest.mark.parametrize("named", ["tangents", "image", "both"])
def test_a_map_that_is_named_and_the_default_one_is_the_same(named: str) -> None:
    mirror, shader = above_a_plane()
    node = plug(shader, "ShaderNodeNormalMap", "Color", image("ripples", ripples(0.1)))
    plain = normals(frame_of(mirror))
    assert np.ptp(plain, axis=0).max() > 0.05
    if named != "image":
        node.uv_map = "UVMap"
    if named != "tangents":
        on_named_map(shader, "UVMap")
    frame = frame_of(mirror)
    assert not frame.warnings
    np.testing.assert_array_equal(normals(frame), plain)


def test_tangents_are_those_of_the_map_that_is_named() -> None:
    mirror, shader = above_a_plane()
    other = mirror.data.uv_layers.new(name="other")
    other.uv.foreach_set("vector", [0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0])
    tilted = np.array([np.sin(TILT), 0.0, np.cos(TILT)])
    node = plug(shader, "ShaderNodeNormalMap", "Color", None, Color=(*(0.5 + 0.5 * tilted), 1.0))
    node.uv_map = "other"
    assert np.abs(normals(frame_of(mirror)) - [0.0, np.sin(TILT), np.cos(TILT)]).max() < 1e-3


def test_procedural_heights_are_shown() -> None:
    mirror, shader = above_a_plane()
    node = plug(shader, "ShaderNodeBump", "Height", None, Distance=0.1)
    noise = shader.id_data.nodes.new("ShaderNodeTexNoise")
    shader.id_data.links.new(noise.outputs["Fac"], node.inputs["Height"])
    frame = frame_of(mirror)
    assert not frame.warnings
    assert np.ptp(normals(frame), axis=0).max() > 0.2


def test_color_and_relief_have_images_of_their_own() -> None:
    """Also when the material is read again."""
    mirror, shader = above_a_plane()
    tree = shader.id_data
    with_normal_map(shader)
    paint = tree.nodes.new("ShaderNodeTexImage")
    paint.image = image("paint", np.full((2, 2, 3), 0.5))
    tree.links.new(paint.outputs["Color"], shader.inputs["Base Color"])
    arrays = extracted(mirror)
    (program,) = [item.program for item in arrays.materials if item.varies("normal")]
    assert program is not None and {"base_color", "normal"} <= set(program.shape.channels)
    assert {arrays.images[use.image].name for use in program.images} == {"paint", "ripples"}
