# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What shadow maps are to hold: not what lies far out of the rest, or they would have no texels left for it. And
whether a cube map holds what has moved."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float64Array
from ..geometry.mesh_pieces import MeshPieces
from ..geometry.scene_geometry import SceneGeometry
from .shadow_maps import ShadowMaps
from .shadow_views import meets_faces

APART = 32.0
"""What reaches so many times farther from the middle of the scene than all that is nearer, half of the objects or more,
is left out. (A map's texels are then a sixtieth of these objects' size, and less would show none of their shadows.)"""
NOTHING = MeshPieces(np.zeros(0, np.int8), np.zeros((0, 3)), np.zeros(0), (np.zeros((0, 3)),))
"""In place of what is left out"""


def stand_apart(centers: Float64Array, radii: Float64Array) -> NDArray[np.bool_]:
    """(n,) which of the balls (n, 3), (n,) around objects are left out."""
    apart = np.zeros(len(centers), bool)
    if len(centers) < 2:
        return apart
    reach = np.linalg.norm(centers - np.median(centers, axis=0), axis=1) + radii
    order = np.argsort(reach, kind="stable")
    nearer = reach[order[:-1]]
    gaps = np.flatnonzero(reach[order[1:]] > APART * nearer)
    gaps = gaps[gaps + 1 >= len(reach) / 2]
    if len(gaps):
        apart[order[gaps[0] + 1 :]] = True
    return apart


def shadow_pieces(geometry: SceneGeometry) -> tuple[list[tuple[MeshPieces, Float64Array, bool]], tuple[str, ...]]:
    """For `SceneExtent`, per instance the pieces of its mesh, its matrix and whether it casts shadows; and a sentence
    for each that casts none because it stands apart. (A ground that is left out gets shadows all the same, and nothing
    is below it.)"""
    apart = stand_apart(*geometry.balls())
    found: list[tuple[MeshPieces, Float64Array, bool]] = []
    names: dict[str, None] = {}
    for item, is_apart in zip(geometry.placed, apart.tolist(), strict=True):
        instance, pieces = item.instance, geometry.facts.of(item.mesh).pieces
        is_ground = len(pieces.areas) == 1 and len(pieces.outlines[0]) == 0
        if is_apart and instance.visible_shadow and not is_ground:
            names[instance.object_name] = None
        found.append((NOTHING if is_apart else pieces, instance.matrix, instance.visible_shadow))
    return found, tuple(
        f'"{name}" is so far from the rest, or so much larger, that it casts no shadows.' for name in names
    )


def cube_holds(
    maps: ShadowMaps, place: Float64Array, layers: tuple[int, ...], centers: Float64Array, radii: Float64Array
) -> bool:
    """Whether balls are within the reach of the cube map at a place (3,), and no face that has no map sees one."""
    near_term, far_term = maps.views[max(layers)].depth_terms
    farthest = far_term / (1.0 - near_term)
    if (np.linalg.norm(centers - place, axis=1) + radii).max() > farthest:
        return False
    if min(layers) >= 0:
        return True
    met = meets_faces(place, centers, radii)
    return all(layer >= 0 or not here for layer, here in zip(layers, met, strict=True))
