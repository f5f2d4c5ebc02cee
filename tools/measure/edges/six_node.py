# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Straight triangles and quadratic patches through the same points."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.renderer.device.records import read_records
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import Float64Array, SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from edges.judge import NEAR, VIEWS, Judge, Seen, numbers, turned

LONG = 4.0
"""Pixels of a triangle's longest side, for --six-node"""


def measure_six_node(arrays: SceneArrays, camera: View, settings: Settings) -> str:
    """One line: straight triangles and quadratic patches through the same points."""
    renderer = Renderer(arrays, settings)
    mirror = renderer.mirrors[0]
    shape = mirror.shape(settings.map_resolution)
    found: dict[str, list[Float64Array]] = {"straight": [], "four straight": [], "six-node": []}
    solves = count = 0
    for degrees, closer in VIEWS:
        view = turned(camera, shape.center, degrees, closer)
        reflection = renderer.reflect(view)
        judge = Judge(mirror, shape, view)
        seen = Seen(view, renderer.surfaces_of(reflection), NEAR * shape.bound)
        for part in (part for part in reflection.parts[0] if part.image == 0):
            points, code, _, _ = part.solution.read()
            world = read_records(part.chunk.positions, part.solution.count)[:, :3].astype(np.float64)
            places = part.places
            pixels = view.project(points.astype(np.float64))
            sides = np.linalg.norm(pixels[places] - pixels[places[:, [1, 2, 0]]], axis=2)
            chosen = (code[places] == status.REFLECTED).all(axis=1) & (sides.max(axis=1) >= LONG)
            chosen &= seen.shows(points.astype(np.float64))[places].any(axis=1)
            corners = world[places[chosen]]
            nodes = np.concatenate([corners, 0.5 * (corners + corners[:, [1, 2, 0]])], axis=1)
            solves += len(np.unique(nodes.reshape(-1, 3).round(5), axis=0))
            at_nodes = _virtual(judge, nodes)
            at_samples = _virtual(judge, np.einsum("sk,nkc->nsc", SAMPLES, corners))
            usable = np.isfinite(at_nodes).all(axis=(1, 2)) & np.isfinite(at_samples).all(axis=(1, 2))
            count += int(usable.sum())
            truth = view.project(at_samples[usable].reshape(-1, 3))
            for name, weights in (("straight", CORNERS), ("four straight", HALVES), ("six-node", QUADRATIC)):
                drawn = np.einsum("sk,nkc->nsc", weights, at_nodes[usable]).reshape(-1, 3)
                found[name].append(np.linalg.norm(view.project(drawn) - truth, axis=1))
    renderer.free()
    errors = "   ".join(numbers(np.concatenate(parts), (50, 99, 99.9)) for parts in found.values())
    return f"{settings.pixel_tolerance:5g} {count // len(VIEWS):9} {solves // len(VIEWS):7}   {errors}"


def _virtual(judge: Judge, places: Float64Array) -> Float64Array:
    """(n, k, 3) where places (n, k, 3) seem to be, NaN where they are not reflected."""
    flat = places.reshape(-1, 3)
    points, is_reflected = judge.points(flat)
    eye = judge.view.eye
    to_eye = eye[:3] - points * eye[3]
    to_eye /= np.linalg.norm(to_eye, axis=1, keepdims=True)
    virtual = points - np.linalg.norm(flat - points, axis=1, keepdims=True) * to_eye
    return np.where(is_reflected[:, None], virtual, np.nan).reshape(places.shape)


def _samples() -> Float64Array:
    """(9, 3) barycentric: the quarters of the sides, and half way from each corner's to the opposite midpoint."""
    lattice = [(i, j, 4 - i - j) for i in range(5) for j in range(5 - i)]
    return np.array([weights for weights in lattice if any(weight % 2 for weight in weights)]) / 4.0


def _quadratic(samples: Float64Array) -> Float64Array:
    """(s, 6) shape functions of corners and of the midpoints of the sides 01, 12, 20."""
    a, b, c = samples.T
    return np.column_stack([*(x * (2.0 * x - 1.0) for x in (a, b, c)), 4.0 * a * b, 4.0 * b * c, 4.0 * c * a])


def _halves(samples: Float64Array) -> Float64Array:
    """(s, 6) weights in the four triangles of corners and midpoints: barycentric in the one that holds the sample."""
    corner = samples.argmax(axis=1)
    at_corner = samples.max(axis=1) >= 0.5
    weights = np.zeros((len(samples), 6))
    for row, (sample, k, near) in enumerate(zip(samples, corner, at_corner, strict=True)):
        if near:
            rest = [(k + 1) % 3, (k + 2) % 3]
            weights[row, k] = 2.0 * sample[k] - 1.0
            weights[row, 3 + k], weights[row, 3 + (k + 2) % 3] = 2.0 * sample[rest[0]], 2.0 * sample[rest[1]]
        else:
            weights[row, [4, 5, 3]] = 1.0 - 2.0 * sample
    return weights


SAMPLES = _samples()
CORNERS = np.column_stack([SAMPLES, np.zeros((len(SAMPLES), 3))])
HALVES, QUADRATIC = _halves(SAMPLES), _quadratic(SAMPLES)
