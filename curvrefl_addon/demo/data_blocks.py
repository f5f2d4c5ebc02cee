# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Blender data-blocks out of arrays: meshes, packed images, Principled materials, lamps, cameras, the world."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

from ..scene.arrays import Float32Array, Float64Array
from .shapes import Numbers, Shape

type Color = tuple[float, float, float]


def add_object(
    name: str,
    shape: Shape,
    material: bpy.types.Material | None = None,
    smooth: bool = False,
    location: Sequence[float] = (0.0, 0.0, 0.0),
    rotation: Sequence[float] = (0.0, 0.0, 0.0),
    normals: Float64Array | None = None,
) -> bpy.types.Object:
    """A mesh object in the scene's own collection. `normals` (vertices, 3) become the mesh's custom normals."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(shape.positions.tolist(), [], [list(p) for p in shape.polygons], shade_flat=not smooth)
    if shape.uv is not None:
        layer = mesh.uv_layers.new(name="UVMap")
        assert layer is not None
        layer.uv.foreach_set("vector", np.ascontiguousarray(shape.uv, np.float32).ravel())
    if normals is not None:
        mesh.normals_split_custom_set_from_vertices(normals.tolist())
    if material is not None:
        mesh.materials.append(material)
    thing = bpy.data.objects.new(name, mesh)
    thing.location = location
    thing.rotation_euler = rotation
    _link(thing)
    return thing


def _link(thing: bpy.types.Object) -> None:
    scene = bpy.context.scene
    assert scene is not None
    scene.collection.objects.link(thing)


def packed_image(name: str, pixels: Float32Array) -> bpy.types.Image:
    """An 8-bit sRGB image of (height, width, 4) sRGB values, kept inside the .blend."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=False)
    flat: Any = np.ascontiguousarray(pixels, np.float32).ravel()
    image.pixels.foreach_set(flat)
    image.update()
    image.pack()
    return image


def principled(
    name: str,
    color: Color = (0.8, 0.8, 0.8),
    metallic: float = 0.0,
    roughness: float = 0.5,
    image: bpy.types.Image | None = None,
    emission: Color | None = None,
    sockets: Mapping[str, float] | None = None,
) -> bpy.types.Material:
    """A material of one Principled BSDF; `color` is scene-linear and is replaced by `image` where there is one.
    `sockets`: values of others by name."""
    material = bpy.data.materials.new(name)
    assert material.node_tree is not None
    # Any: the stubs do not know what the nodes, sockets and lamps of each kind have.
    node: Any = next(n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    node.inputs["Base Color"].default_value = (*color, 1.0)
    node.inputs["Metallic"].default_value = metallic
    node.inputs["Roughness"].default_value = roughness
    if emission is not None:
        node.inputs["Emission Color"].default_value = (*emission, 1.0)
        node.inputs["Emission Strength"].default_value = 1.0
    for socket, value in (sockets or {}).items():
        node.inputs[socket].default_value = value
    if image is not None:
        texture: Any = material.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        texture.location = (-320.0, 300.0)
        material.node_tree.links.new(texture.outputs["Color"], node.inputs["Base Color"])
    material.diffuse_color[:] = (*color, 1.0)
    material.metallic, material.roughness = metallic, roughness
    return material


def mirror(name: str, tint: Color = (0.93, 0.93, 0.94)) -> bpy.types.Material:
    """A perfect metal mirror."""
    return principled(name, tint, metallic=1.0, roughness=0.0)


def emitter(name: str, color: Color) -> bpy.types.Material:
    """Radiance `color` in all directions and no reflection: shows the same color in every engine."""
    material = bpy.data.materials.new(name)
    tree = material.node_tree
    assert tree is not None
    tree.nodes.clear()
    emission: Any = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value = (*color, 1.0)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    output.location = (200.0, 0.0)
    tree.links.new(emission.outputs["Emission"], output.inputs["Surface"])
    material.diffuse_color[:] = (*color, 1.0)
    return material


def looking(eye: Numbers, target: Numbers) -> Float64Array:
    """(4, 4) world matrix of a camera or lamp at `eye` whose -Z points at `target`, Z up where that can be."""
    back = np.asarray(eye, float) - np.asarray(target, float)
    back /= np.linalg.norm(back)
    right = np.cross((0.0, 1.0, 0.0) if abs(back[2]) > 0.9999 else (0.0, 0.0, 1.0), back)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = right, np.cross(back, right), back
    matrix[:3, 3] = eye
    return matrix


def add_camera(
    eye: Numbers,
    target: Numbers,
    lens: float = 50.0,
    orthographic_width: float | None = None,
    clip: tuple[float, float] = (0.01, 100.0),
) -> bpy.types.Object:
    """The scene's camera; `lens` in millimeters on a 36 mm picture, or an orthographic picture so many meters wide."""
    camera = bpy.data.cameras.new("Camera")
    camera.lens = lens
    camera.clip_start, camera.clip_end = clip
    if orthographic_width is not None:
        camera.type = "ORTHO"
        camera.ortho_scale = orthographic_width
    thing = bpy.data.objects.new("Camera", camera)
    thing.matrix_world = Matrix(looking(eye, target).tolist())
    _link(thing)
    scene = bpy.context.scene
    assert scene is not None
    scene.camera = thing
    return thing


def add_sun(
    toward: Numbers, strength: float, color: Color = (1.0, 1.0, 1.0), angle: float = 0.00918
) -> bpy.types.Object:
    """A sun in direction `toward` (from the scene), `strength` in W/m2, `angle` radians across."""
    lamp: Any = bpy.data.lights.new("Sun", "SUN")
    lamp.energy, lamp.color, lamp.angle = strength, color, angle
    thing = bpy.data.objects.new("Sun", lamp)
    thing.matrix_world = Matrix(looking(toward, (0.0, 0.0, 0.0)).tolist())
    _link(thing)
    return thing


def set_world_color(color: Color) -> None:
    """A world of one radiance everywhere."""
    _background().inputs["Color"].default_value = (*color, 1.0)


def set_world_image(path: Path, turn: float, strength: float) -> None:
    """A world of an equirectangular picture, packed into the file, turned by `turn` radians about Z."""
    background = _background()
    tree = background.id_data
    background.inputs["Strength"].default_value = strength
    environment: Any = tree.nodes.new("ShaderNodeTexEnvironment")
    environment.image = bpy.data.images.load(str(path))
    environment.image.pack()
    environment.location = (-300.0, 0.0)
    mapping: Any = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, turn)
    mapping.location = (-500.0, 0.0)
    coordinate = tree.nodes.new("ShaderNodeTexCoord")
    coordinate.location = (-700.0, 0.0)
    tree.links.new(coordinate.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], environment.inputs["Vector"])
    tree.links.new(environment.outputs["Color"], background.inputs["Color"])


def set_world_sky(toward: Numbers, strength: float) -> None:
    """A clear sky lit by a sun in direction `toward` that is itself not in it: a lamp is."""
    background = _background()
    tree = background.id_data
    background.inputs["Strength"].default_value = strength
    sky: Any = tree.nodes.new("ShaderNodeTexSky")
    sky.sky_type, sky.sun_disc = "MULTIPLE_SCATTERING", False
    x, y, z = np.asarray(toward, float) / np.linalg.norm(toward)
    sky.sun_elevation, sky.sun_rotation = float(np.arcsin(z)), float(np.arctan2(x, y))
    sky.location = (-300.0, 0.0)
    tree.links.new(sky.outputs["Color"], background.inputs["Color"])


def _background() -> Any:
    scene = bpy.context.scene
    assert scene is not None
    world = bpy.data.worlds.new("World")
    scene.world = world
    assert world.node_tree is not None
    return next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")


def studio_light(name: str) -> Path:
    """One of the environment pictures that come with Blender, such as 'forest.exr'."""
    utilities: Any = bpy.utils
    folder = Path(utilities.system_resource("DATAFILES", path="studiolights/world"))
    path = folder / name
    if not path.is_file():
        raise FileNotFoundError(f"This Blender came without {name} in {folder}.")
    return path


def start_empty_scene(width: int = 640, height: int = 480) -> bpy.types.Scene:
    """Replace the open file by an empty one (preferences and add-ons stay) that renders width x height in Cycles."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene: Any = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 64
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Standard"
    return scene
