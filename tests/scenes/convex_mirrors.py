# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random closed convex mirrors among random objects, and how far two pictures of one view lie apart in pixels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, unit
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.mirror_halls import slab
from scenes.star_meshes import lattice, mesh_of, star_mesh
from scenes.views import look_at

SIZES = ((320, 240), (640, 480), (960, 720), (1280, 960), (2560, 1920))
SPLIT_ANGLE = np.radians(30.0)
"""Edges that bend more keep two normals, as Blender's Auto Smooth does"""
WINDOW = 3
"""Pixels around one in which what it shows is looked for"""


@dataclass(frozen=True)
class Case:
    """One mirror in one view."""

    text: str
    scene: SceneArrays
    view: View
    tolerance: float


def bevelled_box(rng: np.random.Generator) -> MeshArrays:
    """Of any proportions and bevel."""
    size = np.exp(rng.uniform(np.log(0.05), 0.0, 3))
    bevel = float(size.min() * rng.uniform(0.05, 0.9))
    return rounded_box(size, bevel, int(rng.integers(2, 6)))


def rounded_box(size: np.ndarray, bevel: float, steps: int) -> MeshArrays:
    """Half sizes (3,); flat faces with one normal each, edges and corners rounded in so many steps."""
    quarter = np.linspace(0.0, 0.5 * np.pi, steps)
    around = np.concatenate([quarter + 0.5 * np.pi * index for index in range(4)])
    sign_x = np.repeat([1.0, -1.0, -1.0, 1.0], steps)
    sign_y = np.repeat([1.0, 1.0, -1.0, -1.0], steps)
    polar = np.concatenate([quarter, quarter + 0.5 * np.pi])[:, None]
    sign_z = np.repeat([1.0, -1.0], steps)[:, None]
    directions = np.stack(
        np.broadcast_arrays(np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)), -1
    )
    signs = np.stack(np.broadcast_arrays(sign_x, sign_y, sign_z), -1)
    rows, columns = directions.shape[:2]
    places = signs * (size - bevel) + bevel * directions
    triangles = lattice(rows, columns)
    # The lattice is open at both ends: the two flat faces there.
    ends = []
    for row, turn in ((0, 1), (rows - 1, -1)):
        ring = row * columns + np.arange(columns)
        ends.append(np.column_stack([np.full(columns - 2, ring[0]), ring[1:-1], ring[2:]])[:, ::turn])
    return mesh_of(places.reshape(-1, 3), directions.reshape(-1, 3), np.concatenate([triangles, *ends]))


def turned(profile: np.ndarray, sides: int) -> MeshArrays:
    """The body of revolution about z of a profile (n, 2) of radius and height, from the top down; smooth normals."""
    around = np.arange(sides)[None] * 2.0 * np.pi / sides
    radius, height = profile[:, :1], profile[:, 1:]
    places = np.stack(np.broadcast_arrays(radius * np.cos(around), radius * np.sin(around), height), -1)
    mesh = mesh_of(places.reshape(-1, 3), np.ones((places.size // 3, 3)), lattice(len(profile), sides))
    return with_normals(mesh, np.pi)


def cylinder(rng: np.random.Generator) -> MeshArrays:
    """Upright or flat as a coin."""
    height = float(np.exp(rng.uniform(np.log(0.002), np.log(1.5))))
    sides = int(rng.choice([8, 24, 64, 128]))
    return turned(np.array([(0.0, height), (1.0, height), (1.0, -height), (0.0, -height)]), sides)


def cone(rng: np.random.Generator) -> MeshArrays:
    """With or without a cut tip."""
    height = float(np.exp(rng.uniform(np.log(0.02), np.log(2.0))))
    tip = float(rng.choice([0.0, 0.3]))
    profile = [(0.0, height), (tip, height), (1.0, -height), (0.0, -height)]
    return turned(np.array(profile if tip else [profile[0], *profile[2:]]), int(rng.choice([8, 32, 96])))


def lens(rng: np.random.Generator) -> MeshArrays:
    """Two caps of balls that meet in a sharp rim."""
    thickness = float(np.exp(rng.uniform(np.log(0.002), np.log(0.8))))
    ball = (1.0 + thickness**2) / (2.0 * thickness)
    radius = np.sin(np.linspace(0.0, 0.5 * np.pi, int(rng.choice([6, 12, 32]))))
    height = np.sqrt(np.maximum(ball**2 - radius**2, 0.0)) - (ball - thickness)
    upper = np.column_stack([radius, height])
    return turned(np.concatenate([upper, upper[-2::-1] * (1.0, -1.0)]), int(rng.choice([16, 48, 96])))


def ellipsoid(rng: np.random.Generator) -> MeshArrays:
    """Aspects from 1:1 to 1000:1, few or many triangles."""
    axes = np.exp(rng.uniform(np.log(rng.choice([0.001, 0.02, 0.3])), 0.0, 3))
    axes /= axes.max()
    return star_mesh(Ellipsoid(*axes.tolist()), int(rng.choice([4, 8, 24, 48, 96])))


SHAPES: dict[str, Callable[[np.random.Generator], MeshArrays]] = {
    "box": bevelled_box,
    "cylinder": cylinder,
    "cone": cone,
    "lens": lens,
    "ellipsoid": ellipsoid,
    "sphere": lambda rng: star_mesh(Ellipsoid(), int(rng.choice([4, 8, 24, 48, 96]))),
}
NORMALS: dict[str, float | None] = {"own": None, "smooth": np.pi, "split": SPLIT_ANGLE, "flat": 0.0}
"""Edges that bend more, radians, keep two normals; None leaves the shape's own normals"""


def with_normals(mesh: MeshArrays, angle: float | None) -> MeshArrays:
    """Means of the triangles' normals around each vertex, but over edges that bend by more than `angle` radians."""
    if angle is None:
        return mesh
    corners = mesh.positions[mesh.corner_vertex[mesh.triangles]].astype(np.float64)
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    kept = np.linalg.norm(crossed, axis=1) > 1e-12
    corners, crossed = corners[kept], crossed[kept]
    normals = unit(crossed)
    _, place = np.unique(np.round(corners.reshape(-1, 3), 6), axis=0, return_inverse=True)
    place = place.ravel()
    if angle >= np.pi:
        total = np.zeros((place.max() + 1, 3))
        np.add.at(total, place, np.repeat(crossed, 3, axis=0))
        mine = total[place]
    else:
        mine = np.repeat(normals, 3, axis=0)
        if angle > 0.0:
            face = np.repeat(np.arange(len(normals)), 3)
            order = np.argsort(place, kind="stable")
            starts = np.flatnonzero(np.diff(place[order], prepend=-1))
            for around in np.split(order, starts[1:]):
                near = normals[face[around]] @ normals[face[around]].T >= np.cos(angle) - 1e-9
                mine[around] = near @ crossed[face[around]]
    # Canceled out: any direction is as good.
    mine[np.linalg.norm(mine, axis=1) < 1e-12] = (0.0, 0.0, 1.0)
    return mesh_of(corners.reshape(-1, 3), mine, np.arange(3 * len(corners)).reshape(-1, 3))


def convex_case(seed: int, most_pixels: int = 1 << 30) -> Case:
    """A random mirror of about unit size, few or many objects from contact to far away, a view of at most so many
    pixels."""
    rng = np.random.default_rng(seed)
    kind = str(rng.choice(list(SHAPES)))
    normals = str(rng.choice(list(NORMALS)))
    mesh = with_normals(SHAPES[kind](rng), NORMALS[normals])
    offset = rng.normal(size=3) * rng.choice([0.0, 0.3, 5.0])
    mesh = replace(mesh, positions=(mesh.positions + offset).astype(np.float32))
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    matrix = np.eye(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = -rotation @ offset
    shapes = [mesh, star_mesh(Ellipsoid(), 6), slab()]
    instances = [InstanceArrays("mirror", 1, 0, matrix, (1,))]
    count = int(rng.choice([1, 3, 6, 30]))
    world = (mesh.positions.astype(np.float64) - offset) @ rotation.T
    for index in range(count):
        size = float(rng.uniform(0.05, 0.5))
        direction = unit(rng.normal(size=(1, 3)))[0]
        # From contact with the mirror's farthest point in that direction to a few radii away.
        away = float((world @ direction).max()) + size * 1.001 + rng.choice([0.0, 0.3, 3.0]) * rng.random()
        placed = np.diag([size, size, size, 1.0])
        if rng.random() < 0.5:
            placed[:3, :3] = size / np.sqrt(3.0) * np.linalg.qr(rng.normal(size=(3, 3)))[0]
            if np.linalg.det(placed) < 0.0:
                placed[:3, 0] *= -1.0
        placed[:3, 3] = away * direction
        instances.append(InstanceArrays(f"thing {index}", 2 + index, 1 + int(rng.integers(2)), placed, (0,)))
    materials = (MaterialArrays("gray"), MaterialArrays("chrome", base_color=(1, 1, 1), metallic=1.0, roughness=0.0))
    scene = SceneArrays(
        tuple(shapes), tuple(instances), materials, (), (), WorldArrays((0.5, 0.5, 0.5)), reflectors=(1,)
    )
    sizes = [size for size in SIZES if size[0] * size[1] <= most_pixels]
    width, height = sizes[int(rng.integers(len(sizes)))]
    distance = float(rng.choice([1.3, 2.5, 6.0]))
    eye = distance * unit(rng.normal(size=(1, 3)) * (1, 1, 0.7))[0]
    angle = 2.0 * np.arctan(rng.uniform(0.5, 1.1) / distance)
    view = look_at(eye, 0.05 * rng.normal(size=3), width, height, angle, near=0.01)
    tolerance = float(rng.choice([0.25, 0.5, 1.0, 2.0]))
    text = (
        f"{kind}, {normals} normals, {len(mesh.triangles)} triangles, {count} objects, {width}x{height}, {tolerance} px"
    )
    return Case(text, scene, view, tolerance)


def pixel_errors(frame: Frame, exact: Frame) -> np.ndarray:
    """(n,) for each pixel of the mirror, how many pixels away the exact picture shows the same point of the same
    object, at most WINDOW; 0 where both show the background.

    Around each pixel the exact picture is taken as linear: its derivatives across two pixels say where, in pixels, it
    shows a point near the one that it shows there. What lies beyond an object's outline is off by how far that is.
    """
    mirror = exact.mask() > 0
    ids, true_ids = frame.reflected_object(), exact.reflected_object()
    places, true_places = (item.reflected_position()[..., :3].astype(np.float64) for item in (frame, exact))
    along = [_derivative(true_places, np.where(mirror, true_ids, -1), axis) for axis in (1, 0)]
    rows, columns = np.nonzero(mirror & ((ids > 0) | (true_ids > 0)))
    mine, place = ids[rows, columns], places[rows, columns]
    errors = np.full(len(rows), float(WINDOW))
    height, width = mirror.shape
    for dy in range(-WINDOW, WINDOW + 1):
        for dx in range(-WINDOW, WINDOW + 1):
            r, c = rows + dy, columns + dx
            inside = (r >= 0) & (r < height) & (c >= 0) & (c < width)
            r, c = np.clip(r, 0, height - 1), np.clip(c, 0, width - 1)
            same = inside & mirror[r, c] & (true_ids[r, c] == mine)
            step = _least_squares(along[0][r, c], along[1][r, c], place - true_places[r, c])
            step[mine == 0] = 0.0
            # Beyond its own neighborhood the line is no longer that of the picture.
            near = same & ((np.abs(step) <= 1.0).all(axis=1) | ((dx == 0) & (dy == 0)))
            away = np.hypot(dx + step[:, 0], dy + step[:, 1])
            # A pixel of another object right beside is its outline's.
            outline = (true_ids[rows, columns] != mine) | (mine == 0)
            away = np.where(outline, np.maximum(away - 0.5, 0.0), away)
            errors = np.where(near, np.minimum(errors, away), errors)
    everywhere = np.zeros(int(mirror.sum()))
    everywhere[: len(errors)] = errors
    return everywhere


def _derivative(places: np.ndarray, ids: np.ndarray, axis: int) -> np.ndarray:
    """(h, w, 3) change of what is shown per pixel along an axis, from neighbors that show the same object; 0 without
    any."""
    ahead, behind = (np.roll(ids, -step, axis) == ids for step in (1, -1))
    # (What is rolled in from the other side of the picture is no neighbor.)
    np.moveaxis(ahead, axis, 0)[-1] = False
    np.moveaxis(behind, axis, 0)[0] = False
    forward, backward = np.roll(places, -1, axis) - places, places - np.roll(places, 1, axis)
    count = ahead.astype(np.float64) + behind
    total = np.where(ahead[..., None], forward, 0.0) + np.where(behind[..., None], backward, 0.0)
    return total / np.maximum(count, 1.0)[..., None]


def _least_squares(a: np.ndarray, b: np.ndarray, target: np.ndarray) -> np.ndarray:
    """(n, 2) x, y that bring x a + y b nearest to `target`, all (n, 3); far away where nothing does.

    Damped: along a direction in which the picture hardly changes a place is not looked for.
    """
    aa, ab, bb = ((p * q).sum(-1) for p, q in ((a, a), (a, b), (b, b)))
    at, bt = (a * target).sum(-1), (b * target).sum(-1)
    size = aa + bb
    aa, bb = aa + 1e-3 * size, bb + 1e-3 * size
    inverse = 1.0 / np.maximum(aa * bb - ab * ab, 1e-30)
    steps = np.column_stack([(bb * at - ab * bt) * inverse, (aa * bt - ab * at) * inverse])
    missed = np.linalg.norm(steps[:, :1] * a + steps[:, 1:] * b - target, axis=1)
    steps[(missed > 0.2 * np.sqrt(size)) & (np.linalg.norm(target, axis=1) > 1e-6)] = np.inf
    return steps
