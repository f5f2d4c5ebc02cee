# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cube maps in numpy: OpenGL's face layout, seamless bilinear sampling, and a baked reflector as a radial surface.

Faces are (6, n, n, channels) in the order +X, -X, +Y, -Y, +Z, -Z; [face, row, column] is the texel at
s = (column + 0.5) / n, t = (row + 0.5) / n of the OpenGL specification (4.6 core, section 8.13, table 8.19).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .radial_surfaces import Float64Array, tangential

FACE_AXES = np.array(
    [
        [[0, 0, -1], [0, -1, 0], [1, 0, 0]],
        [[0, 0, 1], [0, -1, 0], [-1, 0, 0]],
        [[1, 0, 0], [0, 0, 1], [0, 1, 0]],
        [[1, 0, 0], [0, 0, -1], [0, -1, 0]],
        [[1, 0, 0], [0, -1, 0], [0, 0, 1]],
        [[-1, 0, 0], [0, -1, 0], [0, 0, -1]],
    ],
    np.float64,
)
"""(6, 3, 3): per face the axes along s, along t, and through the face's center. Each triple is left-handed, as the
axes right, up, forward of a camera are."""


def directions_at(face: NDArray[np.integer], s: Float64Array, t: Float64Array) -> Float64Array:
    """Unit directions (..., 3) of the points s, t on `face`, all of one shape; -1 to 1 spans the face."""
    axes = FACE_AXES[face]
    vectors = axes[..., 0, :] * s[..., None] + axes[..., 1, :] * t[..., None] + axes[..., 2, :]
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def texel_directions(resolution: int) -> Float64Array:
    """Unit directions (6, n, n, 3) of the texel centers of a cube map with n = `resolution`."""
    centers = (2.0 * np.arange(resolution) + 1.0) / resolution - 1.0
    t, s = np.meshgrid(centers, centers, indexing="ij")
    # (A face at a time: what `directions_at` looks up for each point is one for all of them.)
    return np.stack([directions_at(np.array(face), s, t) for face in range(6)])


def face_coordinates(directions: Float64Array) -> tuple[NDArray[np.int64], Float64Array, Float64Array]:
    """Face (m,) and s, t (m,) from -1 to 1 where the directions (m, 3), of any length but 0, meet the cube."""
    axis = np.abs(directions).argmax(axis=1)
    rows = np.arange(len(directions))
    face = 2 * axis + (directions[rows, axis] < 0.0)
    axes = FACE_AXES[face]
    along = np.einsum("mij,mj->mi", axes, directions)
    return face, along[:, 0] / along[:, 2], along[:, 1] / along[:, 2]


def nearest_texel(
    resolution: int, directions: Float64Array
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Face, row and column, (m,) each, of the texel that each direction (m, 3) meets: an index into the faces."""
    face, s, t = face_coordinates(directions)
    column = np.clip(((s + 1.0) * 0.5 * resolution).astype(np.int64), 0, resolution - 1)
    row = np.clip(((t + 1.0) * 0.5 * resolution).astype(np.int64), 0, resolution - 1)
    return face, row, column


def padded(faces: NDArray[np.floating]) -> Float64Array:
    """Faces with a border of one texel from the neighboring faces: (6, n + 2, n + 2, channels).

    The border's corners, where three faces meet and there is no fourth texel, hold the mean of the three.
    """
    resolution, channels = faces.shape[1], faces.shape[3]
    result = np.empty((6, resolution + 2, resolution + 2, channels))
    result[:, 1:-1, 1:-1] = faces
    centers = (2.0 * np.arange(resolution) + 1.0) / resolution - 1.0
    face, along = np.meshgrid(np.arange(6), centers, indexing="ij")
    # Just over the edge: the direction then meets the outermost texels of the neighbor, whatever its orientation.
    beyond = np.full_like(along, 1.0 + 1e-6)

    def neighbors(s: Float64Array, t: Float64Array) -> NDArray[np.floating]:
        return faces[nearest_texel(resolution, directions_at(face, s, t).reshape(-1, 3))].reshape(6, -1, channels)

    result[:, 1:-1, 0] = neighbors(-beyond, along)
    result[:, 1:-1, -1] = neighbors(beyond, along)
    result[:, 0, 1:-1] = neighbors(along, -beyond)
    result[:, -1, 1:-1] = neighbors(along, beyond)
    for row, next_row in ((0, 1), (-1, -2)):
        for column, next_column in ((0, 1), (-1, -2)):
            meeting = result[:, next_row, next_column] + result[:, row, next_column] + result[:, next_row, column]
            result[:, row, column] = meeting / 3.0
    return result


def sample_padded(bordered: Float64Array, directions: Float64Array) -> Float64Array:
    """As `sample_cube`, of faces that `padded` has prepared."""
    resolution = bordered.shape[1] - 2
    face, s, t = face_coordinates(directions)
    # In texels of the bordered face, whose texel 0 is centered half a texel outside the face.
    x = np.clip((s + 1.0) * 0.5 * resolution + 0.5, 0.0, resolution + 1.0)
    y = np.clip((t + 1.0) * 0.5 * resolution + 0.5, 0.0, resolution + 1.0)
    column = np.minimum(x.astype(np.int64), resolution)
    row = np.minimum(y.astype(np.int64), resolution)
    right = (x - column)[:, None]
    up = (y - row)[:, None]
    below = bordered[face, row, column] * (1.0 - right) + bordered[face, row, column + 1] * right
    above = bordered[face, row + 1, column] * (1.0 - right) + bordered[face, row + 1, column + 1] * right
    return below * (1.0 - up) + above * up


def sample_cube(faces: NDArray[np.floating], directions: Float64Array) -> Float64Array:
    """Values (m, channels) of the cube map `faces` in `directions` (m, 3), bilinear and seamless over the edges.

    The same as a samplerCube with linear filtering and seamless edges (OpenGL 4.6 core, section 8.14.3), in float64;
    the GPU's own filter weights have about 8 bits.
    """
    return sample_padded(padded(faces), directions)


@dataclass(frozen=True)
class CubeMapSurface:
    """A baked reflector as a `RadialSurface`: what the solver's shaders see of a radial map, in float64."""

    radial: NDArray[np.floating]
    """(6, n, n, 4): r and its tangential gradient"""

    @property
    def bound(self) -> float:
        return float(self.radial[..., 0].max())

    @cached_property
    def _bordered(self) -> Float64Array:
        return padded(self.radial)

    def radius(self, u: Float64Array) -> tuple[Float64Array, Float64Array]:
        """Radius (m,) and its tangential gradient (m, 3) for unit directions u (m, 3)."""
        sampled = sample_padded(self._bordered, u)
        return sampled[:, 0], tangential(sampled[:, 1:4], u)
