# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The kettle: a chrome body with a spout, which is the mirror, and a wooden handle and knob, which are not.

The body is star-shaped by construction: it is given as a distance in every direction from `BODY_CENTER`. It is convex
but around the rim of its lid and the spout: there it bends both ways, sees itself, and shows things twice.
"""

from __future__ import annotations

import bpy
import numpy as np

from ..scene.arrays import Float64Array
from .data_blocks import add_object, mirror
from .materials import matte
from .shapes import Shape, cube_sphere_directions, star_level, star_normals, tube, turned_profile

KETTLE = "Kettle"
"""Name of the reflector"""

BODY_WIDTH = 0.25
"""Meters, without the spout"""
BODY_CENTER = (0.0, 0.0, 0.092)
"""Meters, in the world: the center that the body is star-shaped about"""
GAP = 2e-4
"""Meters between the kettle and what touches it: 0.002 of its radius, so that nothing pokes into the mirror"""

SPOUT_HEADING, SPOUT_RISE = np.radians(4.0), np.radians(33.0)
"""Of the spout's axis, which goes through the body's center"""
HANDLE_HEADING = np.radians(42.0)
SPOUT_LENGTH = 0.062
"""Meters, out of the body"""
SPOUT_ANGLE = np.radians(8.6)
"""From its axis, where it is half as long"""
MOUTH_ANGLE, MOUTH_DEPTH = np.radians(3.3), 0.012
"""Of the hollow at its end; meters"""
FINE_ANGLE = np.radians(50.0)
"""About the spout, within which the mesh gets finer towards it"""


def spout_axis() -> Float64Array:
    """(3,) unit direction."""
    level = np.cos(SPOUT_RISE)
    return np.array([level * np.cos(SPOUT_HEADING), level * np.sin(SPOUT_HEADING), np.sin(SPOUT_RISE)])


def body_radius(directions: Float64Array) -> Float64Array:
    """Distance (n,) of the kettle's body from `BODY_CENTER` along unit directions (n, 3). Its lowest point is on the
    table."""
    x, y, z = directions.T
    u2 = (x * x + y * y) / (0.5 * BODY_WIDTH) ** 2
    v2 = (z / 0.092) ** 2
    outline = (u2 * u2 + v2 * v2 + 0.7 * u2 * v2) ** -0.25
    polar = np.arctan2(np.hypot(x, y), z)
    shoulder = np.exp(-(((polar - np.radians(47.0)) / np.radians(28.0)) ** 2))
    lid = np.exp(-(((polar - np.radians(34.0)) / np.radians(4.0)) ** 2))
    body = outline * (1.0 - 0.09 * z + 0.09 * z**3 - 0.08 * shoulder + 0.014 * lid)
    # (The sine of half the angle, unlike the angle, has no edge on the axis.)
    from_axis = 2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(directions - spout_axis(), axis=1), 1.0))
    spout = SPOUT_LENGTH / (1.0 + (from_axis / SPOUT_ANGLE) ** 6)
    mouth = MOUTH_DEPTH / (1.0 + (from_axis / MOUTH_ANGLE) ** 8)
    return body + spout - mouth


def body_shape(cells: int) -> Shape:
    """The body about the origin, of 6 cells^2 quads, which are smaller where the spout is."""
    directions, quads = cube_sphere_directions(cells)
    axis = spout_axis()
    angle = np.arccos(np.clip(directions @ axis, -1.0, 1.0))
    t = np.minimum(angle / FINE_ANGLE, 1.0)
    finer = np.where(t < 1.0, FINE_ANGLE * t * (0.4 + 0.6 * t * t), angle)
    across = directions - (directions @ axis)[:, None] * axis
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)
    directions = np.cos(finer)[:, None] * axis + np.sin(finer)[:, None] * across
    return Shape(directions * body_radius(directions)[:, None], quads)


def add_kettle() -> bpy.types.Object:
    """The mirror body with its spout, and its lid's knob and handle, which are not mirrors."""
    shape = body_shape(cells=56)
    directions = shape.positions / np.linalg.norm(shape.positions, axis=1, keepdims=True)
    chrome = mirror("Chrome")
    normals = star_normals(body_radius, directions)
    body = add_object(KETTLE, shape, chrome, smooth=True, location=BODY_CENTER, normals=normals)
    wood = matte("Walnut handle", (0.09, 0.035, 0.016), roughness=0.6)
    add_object("Lid knob", _knob(), wood, smooth=True, location=BODY_CENTER)
    add_object("Handle", _handle(), wood, smooth=True, location=BODY_CENTER)
    return body


def _landed(points: Float64Array, way: Float64Array) -> Float64Array:
    """Points (n, 3), relative to the center, moved along `way` until `GAP` short of the body (they may start in it)."""
    near, far = points - 0.2 * way, points.copy()
    far -= way * ((far @ way)[:, None])
    for _ in range(50):
        middle = 0.5 * (near + far)
        inside = (star_level(body_radius, middle) < GAP)[:, None]
        near, far = np.where(inside, near, middle), np.where(inside, middle, far)
    return near


def _knob() -> Shape:
    """A turned knob standing on the top of the body."""
    profile = [(0.0105, 0.0), (0.0085, 0.004), (0.0075, 0.009), (0.0105, 0.0125), (0.0155, 0.017)]
    profile += [(0.0175, 0.0225), (0.0165, 0.028), (0.012, 0.0325), (0.006, 0.0345), (0.0, 0.035)]
    top = float(body_radius(np.array([[0.0, 0.0, 1.0]]))[0])
    knob = turned_profile(profile, 28).moved((0.0, 0.0, top))
    positions = knob.positions.copy()
    positions[:28] = _landed(positions[:28], np.array([0.0, 0.0, -1.0]))
    return Shape(positions, knob.polygons)


def _handle() -> Shape:
    """An arch over the lid from shoulder to shoulder, past the spout, thicker in the middle."""
    count, segments = 33, 14
    angle = np.linspace(np.pi, 0.0, count)
    across, up = np.cos(angle), np.sin(angle)
    along = 0.083 * np.sign(across) * np.abs(across) ** 0.75
    path = np.column_stack([along, np.zeros(count), 0.07 + 0.094 * up**0.75])
    radii = np.interp(np.abs(across), [0.0, 0.55, 0.75, 1.0], [0.0095, 0.009, 0.0055, 0.0055])
    arch = tube(path, radii, segments, side=(0.0, 1.0, 0.0), capped=False).turned(HANDLE_HEADING)
    positions = arch.positions.copy()
    for ring in (slice(0, segments), slice(len(positions) - segments, None)):
        positions[ring] = _landed(positions[ring], np.array([0.0, 0.0, -1.0]))
    return Shape(positions, arch.polygons)
