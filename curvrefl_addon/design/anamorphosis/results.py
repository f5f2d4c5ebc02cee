# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures in, and anamorphoses into the open file: images, materials, UV maps, meshes."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

import bmesh
import bpy
import numpy as np

from ...errors import InputError
from ...scene.arrays import Float32Array, Float64Array
from ...scene.programs.image_pixels import blender_pixels
from .picture import Picture

NAME = "Anamorphosis"
UNSEEN = -1.0
"""Coordinate of what is not in the picture"""

type Shading = Literal["EMISSION", "PRINCIPLED"]
type Color = tuple[float, float, float]


def read_picture(path: Path) -> tuple[bpy.types.Image, Picture]:
    """An image of the open file for a picture's file, and its pixels. Raises InputError where there are none."""
    if not path.is_file():
        raise InputError(f'There is no picture "{path}": check its path.')
    try:
        image = bpy.data.images.load(str(path), check_existing=True)
    except RuntimeError as error:
        raise InputError(f'"{path}" is no picture that Blender can read.') from error
    pixels = blender_pixels(image)
    space = image.colorspace_settings
    assert space is not None
    if pixels is None:
        if not image.users:
            bpy.data.images.remove(image)
        raise InputError(f'"{path}" is no picture that Blender can read.')
    if not np.isfinite(pixels).all():
        pixels = np.nan_to_num(pixels, nan=0.0, posinf=0.0, neginf=0.0)
    # (Of floats Blender keeps colors times alpha, of bytes not.)
    if image.is_float:
        alpha = pixels[..., 3:]
        colors = np.divide(pixels[..., :3], alpha, out=np.zeros_like(pixels[..., :3]), where=alpha > 0.0)
        pixels = np.concatenate([colors, alpha], axis=2)
    is_encoded = not image.is_float and space.name == "sRGB"
    return image, Picture(pixels, is_encoded)


def keep_image(name: str, pixels: Float32Array, like: bpy.types.Image) -> bpy.types.Image:
    """A new image in the file, packed, of the same kind and color space as another; pixels as `Placed` has them."""
    height, width = pixels.shape[:2]
    image: Any = bpy.data.images.new(name, width, height, alpha=True, float_buffer=like.is_float)
    source: Any = like.colorspace_settings
    image.colorspace_settings.name = source.name
    if like.is_float:
        pixels = np.concatenate([pixels[..., :3] * pixels[..., 3:], pixels[..., 3:]], axis=2)
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    image.update()
    image.pack()
    return image


def picture_material(
    name: str, image: bpy.types.Image, uv_map: str, shading: Shading, paper: Color, is_clipped: bool = True
) -> bpy.types.Material:
    """A material of an image by a UV map, "" for that which is active for rendering, on paper of one color; past its
    edges the image `is_clipped`, or goes on as at its edges."""
    material: Any = bpy.data.materials.new(name)
    tree = material.node_tree
    tree.nodes.clear()
    texture, mix, output = (
        tree.nodes.new(kind) for kind in ("ShaderNodeTexImage", "ShaderNodeMix", "ShaderNodeOutputMaterial")
    )
    texture.image, texture.extension = image, "CLIP" if is_clipped else "EXTEND"
    mix.data_type = "RGBA"
    paper_socket, picture_socket = (socket for socket in mix.inputs if socket.type == "RGBA")
    paper_socket.default_value = (*paper, 1.0)
    tree.links.new(texture.outputs["Alpha"], mix.inputs[0])
    tree.links.new(texture.outputs["Color"], picture_socket)
    mixed = next(socket for socket in mix.outputs if socket.type == "RGBA")
    surface = tree.nodes.new("ShaderNodeEmission" if shading == "EMISSION" else "ShaderNodeBsdfPrincipled")
    if shading == "PRINCIPLED":
        surface.inputs["Roughness"].default_value = 1.0
        surface.inputs["Specular IOR Level"].default_value = 0.0
    tree.links.new(mixed, surface.inputs["Color" if shading == "EMISSION" else "Base Color"])
    tree.links.new(surface.outputs[0], output.inputs["Surface"])
    nodes = [texture, mix, surface, output]
    if uv_map:
        where = tree.nodes.new("ShaderNodeUVMap")
        where.uv_map = uv_map
        tree.links.new(where.outputs["UV"], texture.inputs["Vector"])
        nodes.insert(0, where)
    for number, node in enumerate(nodes):
        node.location = (300.0 * number, 0.0)
    material.diffuse_color[:] = (*paper, 1.0)
    made: bpy.types.Material = material
    return made


def put_on(item: bpy.types.Object, material: bpy.types.Material, faces: list[bool] | None = None) -> None:
    """Give a mesh object this material, or only those of its faces that are chosen."""
    mesh: Any = item.data
    if not len(mesh.materials):
        mesh.materials.append(material if faces is None else None)
    if faces is None:
        for slot in item.material_slots:
            # (Other objects may have the same mesh.)
            slot.link = "OBJECT" if mesh.users > 1 else slot.link
            slot.material = material
        return
    mesh.materials.append(material)
    last = len(mesh.materials) - 1
    for face, is_chosen in zip(mesh.polygons, faces, strict=True):
        if is_chosen:
            face.material_index = last
    mesh.update()


def subdivide(item: bpy.types.Object, cuts: int) -> None:
    """Cut each edge of a mesh so many times. Raises InputError where its mesh is not to be changed."""
    _require_plain(item)
    if cuts:
        mesh: Any = item.data
        work = bmesh.new()
        try:
            work.from_mesh(mesh)
            bmesh.ops.subdivide_edges(work, edges=work.edges[:], cuts=cuts, use_grid_fill=True)
            work.to_mesh(mesh)
        finally:
            work.free()
        mesh.update()


def vertices_of(item: bpy.types.Object) -> Float64Array:
    """(n, 3) world space."""
    mesh: Any = item.data
    positions = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", positions.reshape(-1))
    matrix = np.array(item.matrix_world, np.float64)
    return np.asarray(positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3], np.float64)


def faces_of(item: bpy.types.Object) -> list[list[int]]:
    """Vertices of each face."""
    mesh: Any = item.data
    return [list(face.vertices) for face in mesh.polygons]


def add_uv_map(item: bpy.types.Object, name: str, places: Float64Array) -> str:
    """Add a UV map with the places (vertices, 2) of a mesh's vertices; returns its name, which may have a number."""
    mesh: Any = item.data
    layer = mesh.uv_layers.new(name=name, do_init=False)
    if layer is None:
        raise InputError(f'"{item.name}" has as many UV maps as a mesh can have: remove one.')
    corner = np.empty(len(mesh.loops), np.int32)
    mesh.attributes[".corner_vert"].data.foreach_get("value", corner)
    values = np.where(np.isfinite(places), places, UNSEEN)[corner].astype(np.float32)
    layer.uv.foreach_set("vector", np.ascontiguousarray(values).ravel())
    return str(layer.name)


def add_bent_copy(name: str, mesh: bpy.types.Mesh, points: Float64Array, scene: bpy.types.Scene) -> bpy.types.Object:
    """An object of a mesh whose vertices (n, 3), world space, stand elsewhere: those at NaN go with their faces.

    A mirror swaps the sides of what it shows, so the faces are turned round.
    """
    finite = np.isfinite(points).all(axis=1)
    moved: Any = mesh
    moved.attributes["position"].data.foreach_set(
        "vector", np.where(finite[:, None], points, 0.0).astype(np.float32).ravel()
    )
    moved.flip_normals()
    work = bmesh.new()
    try:
        work.from_mesh(moved)
        work.verts.ensure_lookup_table()
        gone: Any = [work.verts[index] for index in np.flatnonzero(~finite).tolist()]
        bmesh.ops.delete(work, geom=gone, context="VERTS")
        work.to_mesh(moved)
    finally:
        work.free()
    moved.update()
    item = bpy.data.objects.new(name, moved)
    scene.collection.objects.link(item)
    return item


def grid_mesh(name: str, columns: int, rows: int) -> tuple[bpy.types.Mesh, Float64Array]:
    """A mesh of so many quads by so many, without a place yet, with a UV map of the picture; and the place of each of
    its vertices (n, 2) in that."""
    x, y = np.meshgrid(np.linspace(0.0, 1.0, columns + 1), np.linspace(0.0, 1.0, rows + 1))
    places = np.column_stack([x.ravel(), y.ravel()])
    number = np.arange(len(places)).reshape(rows + 1, columns + 1)
    quads = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=-1).reshape(-1, 4)
    mesh: Any = bpy.data.meshes.new(name)
    mesh.from_pydata(np.column_stack([places, np.zeros(len(places))]).tolist(), [], quads.tolist())
    layer = mesh.uv_layers.new(name="UVMap")
    layer.uv.foreach_set("vector", places[quads.ravel()].astype(np.float32).ravel())
    return mesh, places


def require_editable(item: bpy.types.Object) -> None:
    """Raises InputError where an object and its mesh are not to be changed."""
    if not item.is_editable or item.data is None or not item.data.is_editable:
        raise InputError(f'"{item.name}" is linked: make it and its mesh local to put something on it.')


def _require_plain(item: bpy.types.Object) -> None:
    require_editable(item)
    mesh: Any = item.data
    if any(modifier.show_viewport or modifier.show_render for modifier in item.modifiers) or mesh.shape_keys:
        raise InputError(
            f'"{item.name}" has modifiers or shape keys: apply them, as coordinates are put on its vertices.'
        )
