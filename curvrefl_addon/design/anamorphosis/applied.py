# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Anamorphoses into the open file: on surfaces' images, as UV maps of them, as meshes that stand on them or in space.

Each returns sentences, the first about what was made, the others about what is not as it was wished.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ...errors import InputError
from ...scene.arrays import Float64Array
from .bent import SeenPlaces, bent_in_depth, bent_on_surfaces
from .making import Making
from .results import (
    NAME,
    Color,
    Shading,
    add_bent_copy,
    add_uv_map,
    faces_of,
    grid_mesh,
    keep_image,
    picture_material,
    put_on,
    require_editable,
    subdivide,
    vertices_of,
)

SHARP = 1.0
"""Pixels of the picture by which a face may be off"""


def put_images(
    making: Making, like: bpy.types.Image, size: int, uv_map: str, shading: Shading | None, paper: Color
) -> list[str]:
    """An image for each surface, of `size` texels a side; with a `shading`, in a material on it.

    Raises InputError where none of the picture lands on the surfaces, or a mesh is not to be changed.
    """
    items = [bpy.data.objects[surface.name] for surface in making.stage.surfaces]
    if shading is not None:
        for item in items:
            require_editable(item)
    placed = [making.image(surface, size, size) for surface in making.stage.surfaces]
    landing, sentences = making.told(placed)
    if landing.shown == 0.0:
        raise InputError(f"Nothing of the picture lands on the surfaces. {' '.join(sentences[1:])}".strip())
    for item, found in zip(items, placed, strict=True):
        image = keep_image(f"{NAME} {item.name}", found.pixels, like)
        if shading is not None:
            put_on(item, picture_material(image.name, image, uv_map, shading, paper, is_clipped=False))
    return sentences


def put_uvs(making: Making, image: bpy.types.Image, cuts: int, shading: Shading, paper: Color) -> list[str]:
    """A UV map for each surface, whose edges are cut so many times first, and a material with the picture itself on
    the faces that show it. The picture has been followed past its edges, so that these stay straight.

    Raises InputError where no face shows it, or a mesh is not to be changed.
    """
    sentences: list[str] = []
    size = [making.picture.width, making.picture.height]
    for surface in making.stage.surfaces:
        item = bpy.data.objects[surface.name]
        subdivide(item, cuts)
        seen = SeenPlaces(making.anamorphosis, surface.object_id)
        vertices, faces = vertices_of(item), faces_of(item)
        places = seen.of(vertices)
        shown = [_is_in_picture(places[face]) for face in faces]
        if not any(shown):
            continue
        middles = np.array([vertices[face].mean(axis=0) for face, some in zip(faces, shown, strict=True) if some])
        drawn = np.array([places[face].mean(axis=0) for face, some in zip(faces, shown, strict=True) if some])
        off = np.linalg.norm((seen.of(middles) - drawn) * size, axis=1)
        worst = float(off[np.isfinite(off)].max(initial=0.0))
        name = add_uv_map(item, NAME, places)
        put_on(item, picture_material(f"{NAME} {item.name}", image, name, shading, paper), shown)
        more = ": more cuts make that less" if worst > SHARP else ""
        count = sum(shown)
        sentences.append(
            f'The picture is on {count} faces of "{item.name}", off by up to {worst:.1f} of its pixels{more}.'
        )
    if not sentences:
        raise InputError("The mirror shows all corners of no face: choose more cuts, or another surface.")
    return [*sentences, *making.stage.warnings]


def _is_in_picture(places: Float64Array) -> bool:
    """Whether a face whose corners are at these places (n, 2) shows some of the picture."""
    low, high = places.min(axis=0), places.max(axis=0)
    return bool(np.isfinite(places).all() and (high > 0.0).all() and (low < 1.0).all())


@dataclass(frozen=True, slots=True)
class Bending:
    """What is bent back, and where it stands."""

    source: str = ""
    """Name of an object; a grid with the picture where it is empty"""
    in_depth: bool = False
    """As far before the mirror as it is seen behind it; else on the surfaces"""
    depth: float = 0.5
    """Meters from the mirror, of a grid in depth"""
    clearance: float = 0.0
    """Meters from the surfaces"""
    columns: int = 64
    """Of a grid, along the picture's longer side"""


def add_bent(
    making: Making,
    image: bpy.types.Image,
    bending: Bending,
    shading: Shading | None,
    paper: Color,
    scene: bpy.types.Scene,
    depsgraph: bpy.types.Depsgraph,
) -> list[str]:
    """Add an object whose vertices stand where the mirror shows them at the places where those of the source are seen.

    Raises InputError where there is no such source, and where nothing of it has such a place.
    """
    view, mirrors = making.stage.view, set(making.stage.mirrors)
    points = None
    if bending.source:
        mesh, points = _mesh_of(bending.source, depsgraph)
        places = view.project(points) / [view.width, view.height]
    else:
        sides = np.array([making.picture.width, making.picture.height])
        columns, rows = np.maximum(np.rint(bending.columns * sides / sides.max()), 1).astype(int).tolist()
        mesh, own = grid_mesh(NAME, columns, rows)
        places = making.anamorphosis.frame.in_view(own)
    if bending.in_depth:
        bent = bent_in_depth(making.ways, view, mirrors, places, points, bending.depth)
    else:
        ids = {surface.object_id for surface in making.stage.surfaces}
        bent = bent_on_surfaces(making.ways, view, mirrors, places, ids, bending.clearance)
    if not np.isfinite(bent.points).any():
        bpy.data.meshes.remove(mesh)
        raise InputError("The mirror shows no place where any of it could stand: move the frame or the object.")
    item = add_bent_copy(f"{bending.source} bent" if bending.source else NAME, mesh, bent.points, scene)
    own_mesh: Any = item.data
    if not bending.source and shading is not None:
        own_mesh.materials.append(picture_material(item.name, image, "", shading, paper))
    told = [f'"{item.name}" has {len(own_mesh.vertices)} of {len(places)} vertices.']
    if bent.off_mirror:
        told.append(f"{100.0 * bent.off_mirror:.1f} % of the vertices are not seen on the mirror.")
    if bent.nowhere:
        told.append(f"{100.0 * bent.nowhere:.1f} % of the vertices have no place where the mirror would show them.")
    return [*told, *making.stage.warnings]


def _mesh_of(name: str, depsgraph: bpy.types.Depsgraph) -> tuple[bpy.types.Mesh, Float64Array]:
    """A copy of an object's evaluated mesh, and its vertices (n, 3) in world space."""
    item = bpy.data.objects.get(name)
    if item is None:
        raise InputError(f'There is no object "{name}" to bend.')
    try:
        evaluated = item.evaluated_get(depsgraph)
        mesh: Any = bpy.data.meshes.new_from_object(evaluated, preserve_all_data_layers=True, depsgraph=depsgraph)
    except RuntimeError as error:
        raise InputError(f'"{name}" has no surface: choose another object to bend.') from error
    if not len(mesh.vertices):
        bpy.data.meshes.remove(mesh)
        raise InputError(f'"{name}" has no vertices: choose another object to bend.')
    positions = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", positions.reshape(-1))
    matrix = np.array(item.matrix_world, np.float64)
    return mesh, np.asarray(positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3], np.float64)
