# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Test scenes made in the open Blender session: three mirrors among things near and far, the hidden-surface cases,
and a scene of a million vertices.

Every builder replaces the open file, leaves its scene ready to render at the size it names, and returns
the reflector's object. `tools/make_scenes.py` writes them as .blend files.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import bootstrap

bootstrap.load_package()

from curvrefl.curvrefl_addon.demo import paint  # noqa: E402
from curvrefl.curvrefl_addon.demo.data_blocks import (  # noqa: E402
    add_camera,
    add_object,
    add_sun,
    emitter,
    mirror,
    packed_image,
    principled,
    set_world_color,
    set_world_image,
    start_empty_scene,
    studio_light,
)
from curvrefl.curvrefl_addon.demo.shapes import (  # noqa: E402
    RadiusFunction,
    Shape,
    ball,
    box,
    cube_sphere_directions,
    plane,
    slide_to_contact,
    star_normals,
)
from curvrefl.curvrefl_addon.demo.table import add_suzanne  # noqa: E402

from .sheets import LENS, MIRROR, SIZE, Case, Float64Array  # noqa: E402

CELLS = 64
"""The mirrors have 6 CELLS^2 quads: 49152 triangles"""
SKY = (0.32, 0.42, 0.6)


def sphere_radius(directions: Float64Array) -> Float64Array:
    return np.ones(len(directions))


def ellipsoid_radius(directions: Float64Array) -> Float64Array:
    """Semi-axes 2, 0.5 and 1 along X, Y and Z: an oval that faces the camera."""
    return 1.0 / np.linalg.norm(directions / np.array([2.0, 0.5, 1.0]), axis=1)


def bumpy_radius(directions: Float64Array, height: float = 0.06) -> Float64Array:
    """A unit sphere with dents and humps of `height`; hollow in places from about 0.03 on."""
    x, y, z = directions.T
    waves = np.sin(4.0 * x + 0.5) * np.cos(3.0 * y) + 0.7 * np.sin(5.0 * z + 1.0) * np.cos(3.0 * x)
    return 1.0 + height * waves


def mirror_sphere() -> bpy.types.Object:
    """Mirror sphere of radius 1, plain sky, sun. 640 x 480."""
    start_empty_scene()
    reflector = add_reflector(sphere_radius)
    add_surroundings(sphere_radius)
    set_world_color(SKY)
    add_sun((-0.5, -0.6, 0.9), 3.0)
    add_camera((0.0, -5.6, 1.5), (0.0, 0.0, 0.0), lens=58.0)
    return reflector


def mirror_ellipsoid() -> bpy.types.Object:
    """Mirror ellipsoid with semi-axes 2 : 1 : 0.5, in the sunset picture, sun. 640 x 480."""
    start_empty_scene()
    reflector = add_reflector(ellipsoid_radius)
    add_surroundings(ellipsoid_radius)
    set_world_image(studio_light("sunset.exr"), turn=np.radians(60.0), strength=0.6)
    add_sun((-0.5, -0.6, 0.9), 2.5)
    add_camera((-0.5, -6.0, 1.3), (0.0, 0.0, -0.15), lens=48.0)
    return reflector


def bumpy(height: float = 0.06) -> bpy.types.Object:
    """Star-shaped mirror with humps and shallow hollows, plain sky, sun. 640 x 480."""
    start_empty_scene()

    def radius(directions: Float64Array) -> Float64Array:
        return bumpy_radius(directions, height)

    reflector = add_reflector(radius)
    add_surroundings(radius)
    set_world_color(SKY)
    add_sun((0.5, -0.6, 0.9), 3.0)
    add_camera((0.3, -5.6, 1.7), (0.0, 0.0, 0.0), lens=56.0)
    return reflector


def dense() -> bpy.types.Object:
    """The mirror sphere's scene with a mirror of 130,000 triangles."""
    start_empty_scene()
    reflector = add_reflector(sphere_radius, cells=104)
    add_surroundings(sphere_radius)
    set_world_color(SKY)
    add_sun((-0.5, -0.6, 0.9), 3.0)
    add_camera((0.0, -5.6, 1.5), (0.0, 0.0, 0.0), lens=58.0)
    return reflector


def mirror_torus() -> bpy.types.Object:
    """A torus, which shows itself, tilted in the mirror sphere's place. 640 x 480."""
    ring, tube, around = 0.68, 0.3, (192, 96)
    a, b = np.meshgrid(*(np.arange(count) * (2.0 * np.pi / count) for count in around), indexing="ij")
    normals = np.stack([np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)], -1).reshape(-1, 3)
    centers = ring * np.stack([np.cos(a), np.sin(a), np.zeros_like(a)], -1).reshape(-1, 3)
    index = np.arange(a.size).reshape(a.shape)
    after = np.roll(index, -1, 0)
    quads = np.stack([index, after, np.roll(after, -1, 1), np.roll(index, -1, 1)], -1).reshape(-1, 4)
    return _seeing_itself(Shape(centers + tube * normals, tuple(map(tuple, quads.tolist()))), normals, 0.9)


def mirror_bowl() -> bpy.types.Object:
    """A half ball, which shows itself, open and tilted to the eye in the mirror sphere's place. 640 x 480."""
    directions, quads = cube_sphere_directions(CELLS)
    lower = tuple(quad for quad in quads if directions[list(quad), 2].max() < 0.1)
    return _seeing_itself(Shape(directions, lower), directions, 0.6)


def _seeing_itself(shape: Shape, normals: Float64Array, tilt: float) -> bpy.types.Object:
    start_empty_scene()
    reflector = add_object(MIRROR, shape, mirror("Mirror"), smooth=True, normals=normals, rotation=(tilt, 0.0, 0.0))
    add_surroundings(sphere_radius)
    set_world_color(SKY)
    add_sun((-0.5, -0.6, 0.9), 3.0)
    add_camera((0.0, -5.6, 1.5), (0.0, 0.0, 0.0), lens=58.0)
    return reflector


def lamps() -> bpy.types.Object:
    """The mirror sphere's scene in the dark, lit by a weak sun, a point lamp and a spot. 640 x 480."""
    start_empty_scene()
    reflector = add_reflector(sphere_radius)
    add_surroundings(sphere_radius)
    set_world_color((0.0, 0.0, 0.0))
    add_sun((-0.5, -0.6, 0.9), 1.0)
    add_lamp("POINT", (2.2, -2.6, 1.4), 400.0, radius=0.05)
    add_lamp("SPOT", (-3.5, -3.0, 3.5), 1500.0, radius=0.05)
    add_camera((0.0, -5.6, 1.5), (0.0, 0.0, 0.0), lens=58.0)
    return reflector


def add_lamp(kind: str, place: tuple[float, float, float], power: float, radius: float) -> None:
    """A point lamp, or a spot that shines at the origin in a cone of 60 degrees; `power` in W."""
    lamp = bpy.data.lights.new(kind.capitalize(), kind)
    lamp.energy, lamp.shadow_soft_size = power, radius
    thing = bpy.data.objects.new(kind.capitalize(), lamp)
    thing.location = place
    if kind == "SPOT":
        lamp.spot_size, lamp.spot_blend = np.radians(60.0), 0.3
        thing.rotation_euler = (-Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)


def add_reflector(radius: RadiusFunction, cells: int = CELLS) -> bpy.types.Object:
    """The mirror about the origin, with the surface's true normals as custom normals."""
    directions, quads = cube_sphere_directions(cells)
    shape = Shape(directions * radius(directions)[:, None], quads)
    return add_object(MIRROR, shape, mirror("Mirror"), smooth=True, normals=star_normals(radius, directions))


def add_surroundings(radius: RadiusFunction) -> None:
    """About 5000 triangles round a mirror of size 1 at the origin, from 0.01 off its surface to 10 away."""
    rng = np.random.default_rng(5)
    directions, _ = cube_sphere_directions(24)
    floor_height = float((directions * radius(directions)[:, None])[:, 2].min()) - 0.01
    tiles = packed_image("Tiles", paint.chequer(512, 8, (0.80, 0.77, 0.70), (0.30, 0.36, 0.42)))
    floor = plane((20.0, 20.0), (10, 10), tile=4.0)
    add_object("Floor", floor, principled("Tiles", roughness=0.6, image=tiles), location=(0.0, 0.0, floor_height))

    colors = [(0.7, 0.06, 0.05), (0.06, 0.22, 0.65), (0.85, 0.5, 0.04), (0.08, 0.42, 0.12), (0.45, 0.08, 0.5)]
    paints = [principled(f"Paint {i + 1}", color, roughness=0.45) for i, color in enumerate(colors)]

    # In contact: pushed against the mirror from the sides, along the floor.
    for i, (degrees, gap) in enumerate(((-35.0, 0.01), (-150.0, 0.01), (40.0, 0.05), (170.0, 0.02))):
        angle = np.radians(degrees)
        away = np.array([np.cos(angle), np.sin(angle), 0.0])
        if i % 2 == 0:
            size = 0.5
            shape = box((size, size, size), bevel=0.02).turned(angle + 0.4)
        else:
            size = 0.56
            shape = ball(0.5 * size, 24)
        start = 4.0 * away + [0.0, 0.0, floor_height + 0.5 * size + 0.01]
        placed = slide_to_contact(shape.moved(start), -away, radius, (0.0, 0.0, 0.0), gap)
        middle = placed.positions.mean(0)
        add_object(f"Contact {i + 1}", placed.moved(-middle), paints[i], bool(i % 2), location=middle.tolist())

    # Near and far, all round, many of them where the camera does not look.
    distances = np.geomspace(2.6, 10.0, 10)
    for i, distance in enumerate(distances):
        angle = np.radians(-70.0 + 137.5 * i)
        size = float(0.14 * distance * rng.uniform(0.8, 1.3))
        place = (distance * np.cos(angle), distance * np.sin(angle), floor_height + 0.5 * size)
        shape = box((size, size, size), bevel=0.03 * size) if i % 2 else ball(0.5 * size, 16)
        add_object(
            f"Around {i + 1}", shape, paints[i % 5], not i % 2, location=place, rotation=(0.0, 0.0, float(angle))
        )
    add_suzanne((-1.75, -1.75, floor_height + 0.40), size=0.4, toward=np.zeros(3))


# Hidden surfaces --------------------------------------------------------------------------------------------------


def build_case(case: Case) -> bpy.types.Object:
    """One of `hidden_surfaces.CASES` in Blender: raw view transform, SIZE x SIZE, 16 samples of the pixel's center."""
    scene = start_empty_scene(SIZE, SIZE)
    scene.view_settings.view_transform = "Raw"
    scene.cycles.samples = 16
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 0.01
    scene.cycles.diffuse_bounces = 0
    scene.cycles.caustics_reflective = False
    reflector = add_reflector(case.radius)
    reflector.data.materials[0] = mirror("Perfect mirror", (1.0, 1.0, 1.0))
    for sheet in case.sheets:
        # All sheets face up or the camera, but shine on both sides.
        material = (
            principled(sheet.name, sheet.color, roughness=1.0) if sheet.diffuse else emitter(sheet.name, sheet.color)
        )
        if sheet.diffuse:
            node = next(n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
            node.inputs["Specular IOR Level"].default_value = 0.0
        shape = Shape(sheet.corners, (tuple(range(len(sheet.corners))),))
        thing = add_object(sheet.name, shape, material)
        thing.visible_camera = sheet.visible_camera
        thing.visible_glossy = sheet.visible_glossy
        thing.is_holdout = sheet.holdout
    set_world_color(case.world)
    if case.sun_toward is not None:
        # The smallest disc that is still a disc: shadows are sharp.
        add_sun(case.sun_toward, case.sun_strength, angle=1e-4)
        bpy.data.objects["Sun"].visible_glossy = False
    eye = np.asarray(case.eye)
    add_camera(eye, eye + np.array([0.0, 1.0, 0.0]), lens=LENS, orthographic_width=case.orthographic_width)
    return reflector


# A million vertices -----------------------------------------------------------------------------------------------


def million() -> bpy.types.Object:
    """A mirror sphere above hilly ground of a thousand by a thousand vertices, with 2000 instanced stones."""
    start_empty_scene()
    reflector = add_reflector(sphere_radius)
    count = 1000
    x, y = np.meshgrid(np.linspace(-10.0, 10.0, count), np.linspace(-10.0, 10.0, count))
    away = np.hypot(x, y)
    height = 0.35 * np.sin(1.7 * x) * np.cos(1.3 * y) + 0.05 * np.sin(9.0 * x + 2.0 * y) + 0.01 * np.sin(31.0 * y)
    height = height * np.clip((away - 1.0) / 3.0, 0.0, 1.0) - 1.05
    mesh = bpy.data.meshes.new("Ground")
    cells = count - 1
    mesh.vertices.add(count * count)
    mesh.loops.add(4 * cells * cells)
    mesh.polygons.add(cells * cells)
    positions = np.stack([x, y, height], -1).astype(np.float32)
    mesh.attributes["position"].data.foreach_set("vector", positions.ravel())
    index = np.arange(count * count, dtype=np.int32).reshape(count, count)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], -1)
    mesh.loops.foreach_set("vertex_index", quads.ravel())
    mesh.polygons.foreach_set("loop_start", np.arange(0, 4 * cells * cells, 4, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(cells * cells, bool))
    mesh.update(calc_edges=True)
    mesh.materials.append(principled("Sand", (0.62, 0.47, 0.28), roughness=0.9))
    scene = bpy.context.scene
    ground = bpy.data.objects.new("Ground", mesh)
    scene.collection.objects.link(ground)

    rng = np.random.default_rng(11)
    stone = add_object("Stone", ball(0.06, 12), principled("Stone", (0.2, 0.25, 0.3), roughness=0.7), smooth=True)
    places = rng.uniform(-9.5, 9.5, (4000, 2))
    places = places[np.hypot(*places.T) > 1.4][:2000]
    columns = np.clip(((places + 10.0) / 20.0 * cells).round().astype(int), 0, cells)
    for i, (place, (column, row)) in enumerate(zip(places, columns, strict=True)):
        copy = stone if i == 0 else bpy.data.objects.new(f"Stone {i + 1}", stone.data)
        size = float(rng.uniform(0.5, 2.0))
        copy.matrix_world = Matrix.LocRotScale((*place, height[row, column]), None, (size, size, 0.7 * size))
        if i:
            scene.collection.objects.link(copy)
    set_world_color(SKY)
    add_sun((-0.5, -0.6, 0.9), 3.0)
    add_camera((0.0, -5.6, 1.9), (0.0, 0.0, -0.1), lens=50.0)
    return reflector


SCENES: dict[str, Callable[[], bpy.types.Object]] = {
    "sphere": mirror_sphere,
    "ellipsoid": mirror_ellipsoid,
    "bumpy": bumpy,
    "dense": dense,
    "torus": mirror_torus,
    "bowl": mirror_bowl,
    "lamps": lamps,
    "million": million,
}
