# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light between surfaces on a regular grid of probes, to measure patches by: Majercik et al., "Dynamic Diffuse Global
Illumination with Ray-Traced Irradiance Fields", 2019. Pure numpy, but for the rays.

Each probe has irradiance in 8 x 8 directions of an octahedron and mean and square of the distance to what is there in
16 x 16. A place mixes the eight probes about it by where it lies between them, by whether they are before it, and by
Chebyshev's bound of the chance that nothing stands between. A probe that sees the inside of something solid with more
than a quarter of its rays is off. Blending is linear in light; there is no eye, so places are moved along their
normals alone.
"""

from __future__ import annotations

import numpy as np
from light.scene_rays import RAYS_OF_PLACE, Hits, SceneRays

IRRADIANCE_SIDE, DISTANCE_SIDE = 8, 16
SHARPNESS = 50.0
"""Exponent of the cosine by which rays count for a distance"""
MOVED = 0.225
"""Along the normal, in distances between probes: 0.3 of three quarters"""
CRUSHED = 0.2
"""Weights below this fade out fast"""
MOST_WITHIN = 0.25
TETRAHEDRON = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / np.sqrt(3.0)
"""Rays by the cosine about these four are spread over the sphere, within a seventh"""
AT_ONCE = 200_000


class ProbeGrid:
    """About the box between two corners (3,)."""

    def __init__(self, low: np.ndarray, high: np.ndarray, along: int) -> None:
        """`along`: probes along the box's longest side."""
        self.spacing = float((high - low).max()) / (along - 1)
        self.counts = np.maximum(np.ceil((high - low) / self.spacing - 1e-6).astype(np.int64) + 1, 2)
        self.low = 0.5 * (low + high) - 0.5 * self.spacing * (self.counts - 1)
        places = np.stack(np.meshgrid(*(np.arange(n) for n in self.counts), indexing="ij"), axis=-1).reshape(-1, 3)
        self.positions = self.low + self.spacing * places
        self.irradiance = np.zeros((len(self.positions), IRRADIANCE_SIDE**2, 3), np.float32)
        self.distance = np.zeros((len(self.positions), DISTANCE_SIDE**2, 2), np.float32)
        self.is_on = np.ones(len(self.positions), bool)

    @property
    def count(self) -> int:
        return len(self.positions)

    def fill(self, rays: SceneRays, batches: int) -> int:
        """All bounces; so many batches of four rays in each of four directions: returns how many rays it took."""
        places = np.repeat(self.positions, len(TETRAHEDRON), axis=0)
        normals = np.tile(TETRAHEDRON, (self.count, 1))
        hits = rays.follow(places, normals, 0, with_emitters=False)
        for batch in range(1, batches):
            hits = hits.joined(rays.follow(places, normals, batch, with_emitters=False))
        self._keep_distances(hits)
        of_lamps = rays.lit(hits.positions.reshape(-1, 3), hits.normals.reshape(-1, 3), range(rays.lights))
        sent = of_lamps.reshape(hits.albedo.shape)
        # (What shines is known after the first round, before it has bounced.)
        for bounce in range(rays.bounces + (rays.indirect.emitters is not None)):
            arriving = sent if bounce == 0 else sent + self._at_hits(hits)
            self._keep_irradiance(hits, hits.albedo * arriving / np.pi + hits.emission)
        return self.count * len(TETRAHEDRON) * RAYS_OF_PLACE * batches

    def _at_hits(self, hits: Hits) -> np.ndarray:
        met = (hits.albedo > 0.0).any(axis=-1)
        found = np.zeros(hits.albedo.shape, np.float32)
        found[met] = self.at(hits.positions[met], hits.normals[met])
        return found

    def _of_probe(self, values: np.ndarray) -> np.ndarray:
        """(probes, rays, ..) of what is known by place."""
        return values.reshape(self.count, -1, *values.shape[2:])

    def _weights(self, directions: np.ndarray, side: int, sharpness: float) -> np.ndarray:
        """(n, texels, rays) that a ray counts for a texel, of rays of n probes."""
        density = np.maximum(directions @ TETRAHEDRON.T, 0.0).sum(axis=-1)
        cosine = np.maximum(np.einsum("td,prd->ptr", texel_directions(side), directions), 0.0)
        return cosine**sharpness / density[:, None]

    def _keep_distances(self, hits: Hits) -> None:
        self.is_on = self._of_probe(hits.is_within).mean(axis=1) <= MOST_WITHIN
        farthest = 1.5 * np.sqrt(3.0) * self.spacing
        ranges = np.minimum(self._of_probe(hits.ranges), farthest)
        # (As published: what is seen from within is near.)
        ranges = np.where(self._of_probe(hits.is_within), 0.2 * ranges, ranges)
        directions = self._of_probe(hits.directions)
        for some in self._parts(DISTANCE_SIDE, directions.shape[1]):
            weights = self._weights(directions[some], DISTANCE_SIDE, SHARPNESS)
            total = np.maximum(weights.sum(axis=-1), 1e-20)
            for moment in (0, 1):
                sums = np.einsum("ptr,pr->pt", weights, ranges[some] ** (moment + 1))
                self.distance[some, :, moment] = sums / total

    def _keep_irradiance(self, hits: Hits, radiance: np.ndarray) -> None:
        directions, light = self._of_probe(hits.directions), self._of_probe(radiance)
        for some in self._parts(IRRADIANCE_SIDE, directions.shape[1]):
            weights = self._weights(directions[some], IRRADIANCE_SIDE, 1.0)
            total = np.maximum(weights.sum(axis=-1), 1e-20)
            self.irradiance[some] = np.pi * np.einsum("ptr,prc->ptc", weights, light[some]) / total[..., None]

    def _parts(self, side: int, rays: int) -> list[slice]:
        step = max(20_000_000 // (side * side * rays), 1)
        return [slice(first, first + step) for first in range(0, self.count, step)]

    def at(self, positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """(n, 3) irradiance at places (n, 3) that face this way."""
        parts = [
            self._at(positions[first : first + AT_ONCE], normals[first : first + AT_ONCE])
            for first in range(0, len(positions), AT_ONCE)
        ]
        return np.concatenate(parts) if parts else np.zeros((0, 3), np.float32)

    def _at(self, positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
        moved = positions + MOVED * self.spacing * normals
        place = np.clip((moved - self.low) / self.spacing, 0.0, self.counts - 1.0)
        first = np.minimum(place.astype(np.int64), self.counts - 2)
        part = place - first
        texels, shares = bilinear(normals, IRRADIANCE_SIDE)
        total, light = np.zeros(len(positions)), np.zeros((len(positions), 3))
        for corner in range(8):
            step = np.array([corner & 1, (corner >> 1) & 1, corner >> 2])
            x, y, z = (first + step).T
            probe = (x * self.counts[1] + y) * self.counts[2] + z
            weight = self._seen_from(probe, positions, moved, normals)
            weight = np.where(weight < CRUSHED, weight**3 / CRUSHED**2, weight)
            weight *= np.where(step, part, 1.0 - part).prod(axis=-1) * self.is_on[probe]
            light += weight[:, None] * np.einsum("nk,nkc->nc", shares, self.irradiance[probe[:, None], texels])
            total += weight
        return light / np.maximum(total, 1e-20)[:, None]

    def _seen_from(
        self, probe: np.ndarray, positions: np.ndarray, moved: np.ndarray, normals: np.ndarray
    ) -> np.ndarray:
        """(n,) by the side that faces a probe, and by the chance that nothing stands between."""
        to_probe = self.positions[probe] - positions
        to_probe /= np.maximum(np.linalg.norm(to_probe, axis=-1, keepdims=True), 1e-20)
        before = (0.5 * ((to_probe * normals).sum(axis=-1) + 1.0)) ** 2 + 0.2
        away = moved - self.positions[probe]
        distance = np.linalg.norm(away, axis=-1)
        texels, shares = bilinear(away / np.maximum(distance, 1e-20)[:, None], DISTANCE_SIDE)
        mean, square = np.einsum("nk,nkm->mn", shares, self.distance[probe[:, None], texels])
        variance = np.abs(square - mean**2)
        chance = variance / np.maximum(variance + (distance - mean) ** 2, 1e-20)
        return np.maximum(before * np.where(distance > mean, chance**3, 1.0), 1e-6)


def texel_directions(side: int) -> np.ndarray:
    """(side * side, 3) of the middles of texels, rows of v."""
    at = (np.arange(side) + 0.5) / side * 2.0 - 1.0
    u, v = (grid.ravel() for grid in np.meshgrid(at, at))
    found = np.stack([u, v, 1.0 - np.abs(u) - np.abs(v)], axis=-1)
    folded = (1.0 - np.abs(found[:, 1::-1])) * np.where(found[:, :2] < 0.0, -1.0, 1.0)
    found[:, :2] = np.where(found[:, 2:] < 0.0, folded, found[:, :2])
    return found / np.linalg.norm(found, axis=1, keepdims=True)


def bilinear(directions: np.ndarray, side: int) -> tuple[np.ndarray, np.ndarray]:
    """The four texels (n, 4) about directions (n, 3), and what each counts. Over an edge lies what the octahedron has
    there: the same edge, the other way round."""
    d = directions / np.maximum(np.abs(directions).sum(axis=-1, keepdims=True), 1e-20)
    folded = (1.0 - np.abs(d[:, 1::-1])) * np.where(d[:, :2] < 0.0, -1.0, 1.0)
    place = (np.where(d[:, 2:] < 0.0, folded, d[:, :2]) * 0.5 + 0.5) * side - 0.5
    first = np.floor(place).astype(np.int64)
    part = place - first
    texels, shares = [], []
    for corner in range(4):
        step = np.array([corner & 1, corner >> 1])
        x, y = (first + step).T
        over_x, over_y = (x < 0) | (x >= side), (y < 0) | (y >= side)
        inner_x, inner_y = np.clip(x, 0, side - 1), np.clip(y, 0, side - 1)
        turned_x = np.where(over_y, side - 1 - inner_x, inner_x)
        turned_y = np.where(over_x, side - 1 - inner_y, inner_y)
        texels.append(turned_y * side + turned_x)
        shares.append(np.where(step, part, 1.0 - part).prod(axis=-1))
    return np.stack(texels, axis=-1), np.stack(shares, axis=-1)
