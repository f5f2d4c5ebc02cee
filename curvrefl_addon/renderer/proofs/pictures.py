# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces, materials and light in a picture: pixels of a floor under two suns, and of a mirror ball that shows it."""

from __future__ import annotations

import numpy as np

from ...optics.scattering.shaded import shaded_value
from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import (
    Float64Array,
    InstanceArrays,
    LightArrays,
    MaterialArrays,
    SceneArrays,
    WorldArrays,
)
from ...scene.programs.program import Program, Shape
from ..device.shaders import compiled
from ..lighting.ggx import ggx_table
from ..renderer import Renderer
from ..settings import Settings
from ..surfaces.canvas import Canvas
from .cases import ball, lines_of_sight, square, view_of_origin
from .proof import Found, Work
from .walk import joined

PIXELS = 40, 30
PLACE = np.array([2.3, -2.9, 2.8])
"""Of the eye"""
JUDGED = 24
"""Pixels of each kind"""
MOST_OFF = 0.01
"""Of a pixel, in parts of its light"""
MIRROR, FLOOR = 1, 2
SUNS = (((0.3, -0.5, 0.8), (2.0, 1.5, 1.0)), ((-0.7, -0.2, 0.6), (0.3, 0.8, 1.6)))
"""Directions to them, and their irradiance"""
RECORDS = np.array([[1.7, 0.4, 0.2, 0.0], [0.5, 0.45, 0.35, 0.0]], np.float32)
"""Of the floor's program: waves along x, y, z, and the mean of its colors"""
PROGRAM = """
void material_program(ShadingPoint s, inout Material m)
{
  float wave = sin(dot(P(0).xyz, s.position));
  m.base_color = P(1).rgb * (1.0 + 0.5 * wave);
}
"""


def prove_pictures() -> Work:
    """One sub-frame by rays, its pixels one by one."""
    view = view_of_origin(PLACE, *PIXELS)
    scene = _scene()
    renderer = Renderer(scene, Settings(method="exact", samples=1))
    try:
        yield
        reflection = yield from compiled(lambda: renderer.reflect(view, is_still=True))
        yield
        canvas = Canvas.of_size(*PIXELS)

        def draw() -> None:
            canvas.clear()
            renderer.add_sub_frame(canvas, reflection, 0, 1.0)

        yield from compiled(draw)
        yield
        found = canvas.pixels()[..., :3].reshape(-1, 3)
    finally:
        renderer.free()
    yield
    pixels, places, to_viewers = _judged(scene, lines_of_sight(view).reshape(-1, 3), view.eye[:3])
    yield
    truth = np.array([_radiance(*pair) for pair in zip(places, to_viewers, strict=True)])
    off = np.abs(found[pixels] - truth).max(axis=1) / truth.max(axis=1)
    return Found(float(np.nan_to_num(off, nan=np.inf).max()), MOST_OFF, "of a pixel's light")


def _scene() -> SceneArrays:
    floor = MaterialArrays("floor", roughness=0.6, program=Program(Shape(PROGRAM, channels=("base_color",)), RECORDS))
    mirror = MaterialArrays("mirror", base_color=(1.0, 1.0, 1.0), metallic=1.0, roughness=0.0)
    instances = (
        InstanceArrays("mirror", MIRROR, 0, np.eye(4), (1,)),
        InstanceArrays("floor", FLOOR, 1, np.eye(4), (0,)),
    )
    lights = []
    for towards, color in SUNS:
        z = unit(np.array(towards))
        x = unit(np.cross([0.0, 1.0, 0.0], z))
        matrix = np.eye(4)
        matrix[:3, :3] = np.column_stack([x, np.cross(z, x), z])
        lights.append(LightArrays("sun", "SUN", color, matrix, casts_shadow=False))
    meshes = (ball(32), square(8.0, -1.2))
    return SceneArrays(meshes, instances, (floor, mirror), (), tuple(lights), WorldArrays(), (MIRROR,))


def _judged(scene: SceneArrays, rays: Float64Array, eye: Float64Array) -> tuple[np.ndarray, Float64Array, Float64Array]:
    """Pixels (n,) of the floor and of the mirror that shows it, the places (n, 3) seen there, and the unit ways (n, 3)
    from them to where they are seen from. Neighbors of a pixel see the same two things, or rounding would decide."""
    mesh, owner = joined(scene)
    first = mesh.first_hits(np.broadcast_to(eye, rays.shape), rays)
    seen = np.where(first.triangle >= 0, owner[first.triangle], 0)
    places = eye + np.where(seen > 0, first.distance, 0.0)[:, None] * rays
    normal = np.nan_to_num(first.normal)
    facing = -np.einsum("ij,ij->i", normal, rays)
    turned = rays + 2.0 * facing[:, None] * normal
    second = mesh.first_hits(places, turned, least=1e-3)
    shows = np.where((seen == MIRROR) & (second.triangle >= 0), owner[second.triangle], 0)
    kind = _even(10 * seen + shows)
    shown = places + np.where(np.isfinite(second.distance), second.distance, 0.0)[:, None] * turned
    on_floor, on_mirror = (
        _some(np.flatnonzero((kind == wanted) & (facing > 0.35) & near))
        for wanted, near in ((10 * FLOOR, facing > 0.0), (10 * MIRROR + FLOOR, np.abs(turned[:, 2]) > 0.2))
    )
    pixels = np.concatenate([on_floor, on_mirror])
    return (
        pixels,
        np.concatenate([places[on_floor], shown[on_mirror]]),
        -np.concatenate([rays[on_floor], turned[on_mirror]]),
    )


def _even(kind: np.ndarray) -> np.ndarray:
    """What pixels (n,) show whose neighbors show the same, else -1."""
    picture = kind.reshape(PIXELS[1], PIXELS[0])
    same = np.ones(picture.shape, bool)
    for axis in (0, 1):
        for step in (-1, 1):
            same &= np.roll(picture, step, axis) == picture
    same[[0, -1]] = same[:, [0, -1]] = False
    return np.where(same, picture, -1).ravel()


def _some(pixels: np.ndarray) -> np.ndarray:
    return pixels[np.linspace(0, len(pixels) - 1, min(JUDGED, len(pixels))).astype(int)]


def _radiance(place: Float64Array, to_viewer: Float64Array) -> Float64Array:
    """(3,) of the floor at a place (3,) towards a viewer (3,)."""
    color = RECORDS[1, :3].astype(np.float64) * (1.0 + 0.5 * np.sin(RECORDS[0, :3].astype(np.float64) @ place))
    material = MaterialArrays("floor", base_color=(color[0], color[1], color[2]), roughness=0.6)
    lights = unit(np.array([towards for towards, _ in SUNS]))
    viewers = np.broadcast_to(to_viewer, lights.shape)
    value = shaded_value(material, viewers, lights, ggx_table().astype(np.float64))
    return np.asarray((value * np.array([color for _, color in SUNS])).sum(axis=0))
