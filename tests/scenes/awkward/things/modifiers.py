# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirrors that modifiers shape."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import MIRROR, awkward
from ..stage import add_ball, add_object, ball, box, bpy, find, link, matte, mesh_of, mirror, plane, stage
from .shapes import empty_stage


@awkward("a shape key half on")
def shape_key(folder: Path) -> None:
    stage()
    thing = find(MIRROR)
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="Egg")
    for point in key.data:
        point.co.z *= 1.6
    key.value = 0.5


@awkward("an armature that bends the mirror")
def shape_armature(folder: Path) -> None:
    scene = stage()
    armature = bpy.data.armatures.new("Bones")
    rig = bpy.data.objects.new("Rig", armature)
    scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for number in range(2):
        bone = armature.edit_bones.new(f"Bone {number}")
        bone.head, bone.tail = (0.0, 0.0, float(number)), (0.0, 0.0, 1.0 + number)
    bpy.ops.object.mode_set(mode="OBJECT")
    thing = find(MIRROR)
    for number in range(2):
        group = thing.vertex_groups.new(name=f"Bone {number}")
        for vertex in thing.data.vertices:
            upper = float(np.clip(vertex.co.z + 0.5, 0.0, 1.0))
            group.add([vertex.index], upper if number else 1.0 - upper, "REPLACE")
    modifier: Any = thing.modifiers.new("Armature", "ARMATURE")
    modifier.object = rig
    rig.pose.bones["Bone 1"].rotation_mode = "XYZ"
    rig.pose.bones["Bone 1"].rotation_euler = (0.5, 0.0, 0.3)


@awkward("a lattice round the mirror")
def shape_lattice(folder: Path) -> None:
    stage()
    lattice = bpy.data.lattices.new("Cage")
    cage = link(lattice, "Cage", (0.0, 0.0, 1.0))
    cage.scale = (2.2, 2.2, 2.2)
    for point in lattice.points:
        if point.co.z > 0.0:
            point.co_deform = (0.5 * point.co.x, point.co.y, point.co.z)
    modifier: Any = find(MIRROR).modifiers.new("Lattice", "LATTICE")
    modifier.object = cage


def _modified(kind: str, **properties: Any) -> Any:
    modifier: Any = find(MIRROR).modifiers.new(kind.capitalize(), kind)
    for name, value in properties.items():
        setattr(modifier, name, value)
    return modifier


@awkward("thickness by Solidify")
def shape_solidify(folder: Path) -> None:
    add_object(MIRROR, plane((2.0, 2.0), (8, 8)), empty_stage(), True, (0.0, 0.3, 1.1), (np.pi / 2.0, 0.0, 0.2))
    _modified("SOLIDIFY", thickness=0.2)


@awkward("a bevelled cube with hardened normals")
def shape_bevel(folder: Path) -> None:
    add_object(MIRROR, box((1.5, 1.5, 1.5)), empty_stage(), True, (0.0, 0.0, 0.9), (0.0, 0.0, 0.5))
    _modified("BEVEL", width=0.2, segments=4, harden_normals=True)


@awkward("a hole by Boolean")
def shape_boolean(folder: Path) -> None:
    stage()
    cutter = add_object("Cutter", box((0.8, 3.0, 0.8)), matte("Cut", (0.7, 0.1, 0.1)), location=(0.0, 0.0, 1.2))
    cutter.hide_render, cutter.display_type = True, "WIRE"
    _modified("BOOLEAN", object=cutter, solver="EXACT")


@awkward("waves by Displace")
def shape_displace(folder: Path) -> None:
    stage()
    texture = bpy.data.textures.new("Clouds", "CLOUDS")
    texture.noise_scale = 0.6
    _modified("DISPLACE", texture=texture, strength=0.3)


@awkward("decimated to few triangles")
def shape_decimate(folder: Path) -> None:
    stage()
    _modified("DECIMATE", ratio=0.05)


@awkward("a remesh by voxels")
def shape_remesh(folder: Path) -> None:
    stage()
    _modified("REMESH", mode="VOXEL", voxel_size=0.08, use_smooth_shade=True)


@awkward("weighted normals and triangulation")
def shape_weighted_normals(folder: Path) -> None:
    add_object(MIRROR, box((1.5, 1.5, 1.5), 0.2), empty_stage(), True, (0.0, 0.0, 0.9), (0.0, 0.0, 0.5))
    _modified("TRIANGULATE")
    _modified("WEIGHTED_NORMAL")


@awkward("an array of mirrors")
def shape_array(folder: Path) -> None:
    stage()
    find(MIRROR).scale = (0.45, 0.45, 0.45)
    find(MIRROR).location = (-1.2, 0.0, 0.5)
    _modified("ARRAY", count=3, relative_offset_displace=(1.2, 0.0, 0.0))


@awkward("a Mirror modifier on the mirror")
def shape_mirror_modifier(folder: Path) -> None:
    add_object(MIRROR, ball(0.6, 32), empty_stage(), True, (0.0, 0.0, 0.8))
    for vertex in find(MIRROR).data.vertices:
        vertex.co.x += 0.7
    _modified("MIRROR")


@awkward("skin of edges")
def shape_skin(folder: Path) -> None:
    chrome = empty_stage()
    thing = mesh_of(MIRROR, [(-1.0, 0, 0.3), (0, 0, 1.0), (1.0, 0, 0.4), (0, 0, 2.0)], [], chrome)
    thing.data.edges.add(3)
    for number, pair in enumerate(((0, 1), (1, 2), (1, 3))):
        thing.data.edges[number].vertices = pair
    thing.data.update()
    _modified("SKIN", use_smooth_shade=True)
    _modified("SUBSURF", levels=2, render_levels=2)


@awkward("cloth that has been simulated for some frames")
def shape_cloth(folder: Path) -> None:
    scene = stage(with_mirror=False)
    add_object(MIRROR, plane((2.4, 2.4), (16, 16)), mirror("Chrome"), True, (0.0, 0.0, 1.6))
    bump = add_ball("Post", (0.0, 0.0, 0.7), 0.7, matte("Post", (0.6, 0.5, 0.1)))
    bump.modifiers.new("Collision", "COLLISION")
    _modified("CLOTH")
    for frame in range(1, 9):
        scene.frame_set(frame)


@awkward("a mirror of hundred thousand triangles")
def shape_dense(folder: Path) -> None:
    add_ball(MIRROR, (0.0, 0.0, 1.0), 1.0, empty_stage(), 320)


@awkward("a mirror of one triangle")
def shape_triangle(folder: Path) -> None:
    mesh_of(MIRROR, [(-1.3, 0.3, 0.1), (1.3, 0.3, 0.3), (0.1, 0.1, 2.2)], [(0, 1, 2)], empty_stage())


@awkward("a polygon with a dent")
def shape_concave_polygon(folder: Path) -> None:
    positions = [(-1.4, 0, 0.1), (1.4, 0, 0.1), (1.4, 0, 2.0), (0.0, 0, 0.6), (-1.4, 0, 2.0)]
    mesh_of(MIRROR, positions, [(0, 1, 2, 3, 4)], empty_stage())


@awkward("quads that are not flat")
def shape_bent_quads(folder: Path) -> None:
    shape = plane((2.6, 2.0), (3, 2))
    positions = shape.positions.copy()
    positions[:, 2] = 0.35 * np.sin(9.0 * positions[:, 0]) * np.cos(7.0 * positions[:, 1])
    thing = mesh_of(MIRROR, positions, shape.polygons, empty_stage(), smooth=True)
    thing.location, thing.rotation_euler = (0.0, 0.2, 1.1), (np.pi / 2.0, 0.0, 0.0)


@awkward("the mesh in edit mode as the file is saved")
def shape_edit_mode(folder: Path) -> None:
    stage()
    bpy.context.view_layer.objects.active = find(MIRROR)
    find(MIRROR).select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")


@awkward("a name with quotes, a comma-free list of odd letters", mirrors=('Mïrrör "7" 鏡',))
def shape_odd_name(folder: Path) -> None:
    stage()
    find(MIRROR).name = 'Mïrrör "7" 鏡'


@awkward("a very small mirror in a very close view")
def shape_tiny_scene(folder: Path) -> None:
    scene = stage()
    for thing in list(scene.objects):
        thing.location *= 1e-3
        if thing.type == "MESH":
            thing.scale = 1e-3 * thing.scale
    scene.camera.data.clip_start = 1e-5


@awkward("a star-shaped body with spikes")
def shape_spikes(folder: Path) -> None:
    from curvrefl.curvrefl_addon.demo.shapes import star_shape

    def radius(directions: Any) -> Any:
        return 0.6 + 0.5 * np.abs(np.prod(np.sin(5.0 * directions), axis=1))

    add_object(MIRROR, star_shape(radius, 32), empty_stage(), True, (0.0, 0.0, 1.0))
