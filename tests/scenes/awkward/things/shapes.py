# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirrors of every kind of geometry."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from mathutils import Matrix

from ..registry import MIRROR, awkward
from ..stage import add_ball, add_object, add_sheet, ball, box, bpy, find, link, mesh_of, mirror, stage


def empty_stage() -> bpy.types.Material:
    """The stage without its mirror; returns chrome for another."""
    stage(with_mirror=False)
    return mirror("Chrome")


@awkward("a curve with a bevel")
def shape_curve(folder: Path) -> None:
    chrome = empty_stage()
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.9, location=(0.0, 0.0, 1.1), rotation=(1.2, 0.0, 0.0))
    bpy.context.object.name = MIRROR
    curve = bpy.context.object.data
    curve.bevel_depth, curve.bevel_resolution = 0.3, 6
    curve.materials.append(chrome)


@awkward("a curve without thickness", words=("Mirror",))
def shape_curve_bare(folder: Path) -> None:
    chrome = empty_stage()
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.9, location=(0.0, 0.0, 1.1))
    bpy.context.object.name = MIRROR
    bpy.context.object.data.materials.append(chrome)


@awkward("text with a bevel")
def shape_text(folder: Path) -> None:
    chrome = empty_stage()
    bpy.ops.object.text_add(location=(-1.4, -0.2, 0.4), rotation=(np.pi / 2.0, 0.0, 0.0))
    bpy.context.object.name = MIRROR
    text = bpy.context.object.data
    text.body, text.size, text.extrude, text.bevel_depth, text.bevel_resolution = "Oc", 2.2, 0.15, 0.06, 3
    text.materials.append(chrome)


@awkward("metaballs")
def shape_metaballs(folder: Path) -> None:
    chrome = empty_stage()
    data: Any = bpy.data.metaballs.new(MIRROR)
    data.resolution = data.render_resolution = 0.12
    for x, z in ((-0.5, 0.0), (0.5, 0.2), (0.0, 0.8)):
        element = data.elements.new()
        element.co, element.radius = (x, 0.0, z), 0.9
    data.materials.append(chrome)
    link(data, MIRROR, (0.0, 0.0, 0.8))


@awkward("a NURBS ball")
def shape_nurbs(folder: Path) -> None:
    chrome = empty_stage()
    bpy.ops.surface.primitive_nurbs_surface_sphere_add(radius=1.0, location=(0.0, 0.0, 1.0))
    bpy.context.object.name = MIRROR
    bpy.context.object.data.materials.append(chrome)


@awkward("a mirrored scale")
def shape_scale_negative(folder: Path) -> None:
    stage()
    find(MIRROR).scale = (-1.0, 0.7, 1.2)


@awkward("three mirrored axes")
def shape_scale_all_negative(folder: Path) -> None:
    stage()
    find(MIRROR).scale = (-1.0, -0.7, -1.2)


@awkward("a mirror flattened by its scale", words=("flat", "scale", "Mirror"))
def shape_scale_zero(folder: Path) -> None:
    stage()
    find(MIRROR).scale = (1.0, 0.0, 1.0)


@awkward("a mirror sheared by its parent")
def shape_shear(folder: Path) -> None:
    scene = stage()
    parent = bpy.data.objects.new("Parent", None)
    parent.scale, parent.rotation_euler = (1.0, 1.0, 0.5), (0.5, 0.0, 0.0)
    scene.collection.objects.link(parent)
    find(MIRROR).parent = parent
    find(MIRROR).rotation_euler = (0.6, 0.4, 0.0)


@awkward("flipped normals")
def shape_flipped(folder: Path) -> None:
    stage()
    find(MIRROR).data.flip_normals()


@awkward("half of the faces flipped")
def shape_half_flipped(folder: Path) -> None:
    stage()
    mesh = find(MIRROR).data
    import bmesh

    edit = bmesh.new()
    edit.from_mesh(mesh)
    bmesh.ops.reverse_faces(edit, faces=[face for face in edit.faces if face.calc_center_median().x > 0.0])
    edit.to_mesh(mesh)
    edit.free()


@awkward("flat shading: facets")
def shape_flat(folder: Path) -> None:
    stage()
    find(MIRROR).data.shade_flat()


@awkward("a coarse ball, shaded smooth")
def shape_coarse(folder: Path) -> None:
    add_ball(MIRROR, (0.0, 0.0, 1.0), 1.0, empty_stage(), 8)


@awkward("a cube, shaded smooth")
def shape_cube_smooth(folder: Path) -> None:
    add_object(MIRROR, box((1.4, 1.4, 1.4)), empty_stage(), smooth=True, location=(0.0, 0.0, 0.9), rotation=(0, 0, 0.5))


@awkward("a cube")
def shape_cube(folder: Path) -> None:
    add_object(MIRROR, box((1.4, 1.4, 1.4)), empty_stage(), location=(0.0, 0.0, 0.9), rotation=(0.0, 0.0, 0.5))


@awkward("a flat mirror")
def shape_plane(folder: Path) -> None:
    add_sheet(MIRROR, (0.0, 0.5, 1.0), (3.0, 2.0), empty_stage(), (np.pi / 2.0, 0.0, 0.1))


@awkward("a flat mirror seen from behind")
def shape_plane_behind(folder: Path) -> None:
    add_sheet(MIRROR, (0.0, 0.5, 1.0), (3.0, 2.0), empty_stage(), (-np.pi / 2.0, 0.0, 0.1))


@awkward("a floor of two hundred mirror tiles in one mesh")
def shape_tiles(folder: Path) -> None:
    chrome = empty_stage()
    rng = np.random.default_rng(2)
    positions, polygons = [], []
    for x in np.linspace(-1.4, 1.4, 14):
        for z in np.linspace(0.2, 2.0, 10):
            turn = Matrix.Rotation(0.2 * rng.standard_normal(), 3, "Z") @ Matrix.Rotation(
                0.2 * rng.standard_normal(), 3, "X"
            )
            corners = [(-0.09, 0, -0.09), (0.09, 0, -0.09), (0.09, 0, 0.09), (-0.09, 0, 0.09)]
            polygons.append(range(len(positions), len(positions) + 4))
            positions += [
                tuple(
                    turn @ Matrix.Identity(3) @ Matrix.Translation(c).translation
                    + Matrix.Translation((x, 0, z)).translation
                )
                for c in corners
            ]
    mesh_of(MIRROR, positions, polygons, chrome)


@awkward("a bowl, which shows itself", words=("bounce", "itself"))
def shape_bowl(folder: Path) -> None:
    chrome = empty_stage()
    shape = ball(1.2, 48)
    low = [p for p in shape.polygons if shape.positions[list(p), 2].max() < 0.2]
    mesh_of(MIRROR, shape.positions, low, chrome, smooth=True).location = (0.0, 0.0, 1.25)
    find(MIRROR).rotation_euler = (0.5, 0.0, 0.0)


@awkward("a torus, which shows itself")
def shape_torus(folder: Path) -> None:
    chrome = empty_stage()
    bpy.ops.mesh.primitive_torus_add(
        major_radius=0.9, minor_radius=0.35, major_segments=64, minor_segments=32, location=(0.0, 0.0, 1.0)
    )
    bpy.context.object.name = MIRROR
    bpy.context.object.rotation_euler = (0.9, 0.0, 0.0)
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(chrome)


@awkward("a Moebius strip: no outside")
def shape_moebius(folder: Path) -> None:
    chrome = empty_stage()
    count = 64
    positions = []
    for number in range(count):
        t = 2.0 * np.pi * number / count
        for s in (-0.35, 0.35):
            r = 0.9 + s * np.cos(t / 2.0)
            positions.append((r * np.cos(t), r * np.sin(t), s * np.sin(t / 2.0)))
    polygons = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(count - 1)]
    polygons.append((2 * count - 2, 2 * count - 1, 0, 1))
    thing = mesh_of(MIRROR, positions, polygons, chrome, smooth=True)
    thing.location, thing.rotation_euler = (0.0, 0.0, 1.1), (0.8, 0.0, 0.0)


@awkward("three faces at one edge")
def shape_non_manifold(folder: Path) -> None:
    positions = [
        (0, 0, 0),
        (0, 0, 2),
        (1.2, -0.4, 0),
        (1.2, -0.4, 2),
        (-1.2, -0.4, 0),
        (-1.2, -0.4, 2),
        (0, 1, 0),
        (0, 1, 2),
    ]
    mesh_of(MIRROR, positions, [(0, 2, 3, 1), (0, 4, 5, 1), (0, 6, 7, 1)], empty_stage(), smooth=True)


@awkward("edges and points without faces beside the faces")
def shape_loose(folder: Path) -> None:
    stage()
    mesh = find(MIRROR).data
    start = len(mesh.vertices)
    mesh.vertices.add(3)
    for number, place in enumerate(((2.0, 0.0, 3.0), (5.0, 5.0, 5.0), (-30.0, 0.0, 8.0))):
        mesh.vertices[start + number].co = place
    mesh.edges.add(1)
    mesh.edges[-1].vertices = (start, start + 1)
    mesh.update()


@awkward("edges alone", words=("Mirror",))
def shape_edges_only(folder: Path) -> None:
    chrome = empty_stage()
    thing = mesh_of(MIRROR, [(0, 0, 0), (0, 0, 2)], [], chrome)
    thing.data.edges.add(1)
    thing.data.edges[0].vertices = (0, 1)


@awkward("triangles without area")
def shape_zero_area(folder: Path) -> None:
    chrome = empty_stage()
    shape = ball(1.0, 48)
    positions = np.concatenate((shape.positions, np.zeros((3, 3))))
    n = len(shape.positions)
    polygons = [*shape.polygons, (n, n + 1, n + 2)]
    mesh_of(MIRROR, positions, polygons, chrome, smooth=True).location = (0.0, 0.0, 1.0)


@awkward("faces that are there twice: Cycles itself shows noise where all are")
def shape_duplicated(folder: Path) -> None:
    chrome = empty_stage()
    shape = ball(1.0, 48)
    n = len(shape.positions)
    positions = np.concatenate((shape.positions, shape.positions))
    polygons = [*shape.polygons, *(tuple(i + n for i in p) for p in shape.polygons[::60])]
    mesh_of(MIRROR, positions, polygons, chrome, smooth=True).location = (0.0, 0.0, 1.0)


@awkward("two shells, one in the other, turned inside out")
def shape_double_shell(folder: Path) -> None:
    chrome = empty_stage()
    shape = ball(1.0, 48)
    n = len(shape.positions)
    positions = np.concatenate((shape.positions, 0.999 * shape.positions))
    polygons = [*shape.polygons, *(tuple(i + n for i in reversed(p)) for p in shape.polygons)]
    mesh_of(MIRROR, positions, polygons, chrome, smooth=True).location = (0.0, 0.0, 1.0)


@awkward("custom normals that turn the facets round")
def shape_custom_normals(folder: Path) -> None:
    stage()
    mesh = find(MIRROR).data
    normals = np.array([v.co[:] for v in mesh.vertices])
    normals[:, 0] += 0.3 * np.sin(6.0 * normals[:, 2])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    mesh.normals_split_custom_set_from_vertices(normals.tolist())


@awkward("sharp edges in a smooth mesh")
def shape_sharp_edges(folder: Path) -> None:
    stage()
    mesh = find(MIRROR).data
    for edge in mesh.edges:
        edge.use_edge_sharp = abs(mesh.vertices[edge.vertices[0]].co.z - mesh.vertices[edge.vertices[1]].co.z) < 1e-6
