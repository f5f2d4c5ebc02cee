# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that are not numbers, places that are far, sizes that are odd."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mathutils import Matrix

from ..registry import MIRROR, awkward
from ..stage import add_ball, add_box, add_lamp, add_object, bpy, find, matte, plane, principled_node, stage

NAN, INF = float("nan"), float("inf")


@awkward("one thing at no place", words=("Lost", "not a number", "finite"))
def nan_place(folder: Path) -> None:
    stage()
    lost = add_box("Lost", (0.0, 0.0, 0.0), 1.0, matte("Lost", (0.8, 0.8, 0.1)))
    lost.location.x = NAN


@awkward("one thing of endless scale", words=("Lost", "endless", "finite"))
def inf_scale(folder: Path) -> None:
    stage()
    lost = add_box("Lost", (0.0, -2.0, 0.5), 1.0, matte("Lost", (0.8, 0.8, 0.1)))
    lost.scale.z = INF


@awkward("one thing with a vertex that is not a number", words=("Lost", "not a number", "finite"))
def nan_vertex(folder: Path) -> None:
    stage()
    lost = add_ball("Lost", (-0.6, -2.0, 0.4), 0.4, matte("Lost", (0.8, 0.8, 0.1)))
    lost.data.vertices[100].co.z = NAN


@awkward("a mirror with a vertex that is not a number", words=("Mirror",))
def nan_mirror_vertex(folder: Path) -> None:
    stage()
    find(MIRROR).data.vertices[100].co.z = NAN


@awkward("a mirror at no place", words=("Mirror",))
def nan_mirror_place(folder: Path) -> None:
    stage()
    find(MIRROR).location.x = NAN


@awkward("a camera at no place", words=("Camera",))
def nan_camera(folder: Path) -> None:
    stage().camera.location.x = NAN


@awkward("a lamp at no place", words=("Point", "lamp", "light", "finite"))
def nan_lamp_place(folder: Path) -> None:
    stage()
    add_lamp("POINT", (1.0, -2.0, 2.0), 100.0).location.x = NAN


@awkward("a lamp whose power is not a number", words=("Point", "lamp", "light", "finite"))
def nan_lamp_power(folder: Path) -> None:
    stage()
    add_lamp("POINT", (1.0, -2.0, 2.0), 100.0).data.energy = NAN


@awkward("a lamp of endless power", words=("Point", "lamp", "light", "finite"))
def inf_lamp_power(folder: Path) -> None:
    stage()
    add_lamp("POINT", (1.0, -2.0, 2.0), 100.0).data.energy = INF


@awkward("a color that is not a number", words=("Red", "not a number", "finite"))
def nan_color(folder: Path) -> None:
    stage()
    principled_node(bpy.data.materials["Red"]).inputs["Base Color"].default_value = (NAN, 0.1, 0.1, 1.0)


@awkward("a UV that is not a number")
def nan_uv(folder: Path) -> None:
    stage()
    layer = find("Blue").data.uv_layers[0]
    layer.uv[50].vector.x = NAN


@awkward("a color over 1 and one under 0")
def colors_out_of_range(folder: Path) -> None:
    stage()
    principled_node(bpy.data.materials["Red"]).inputs["Base Color"].default_value = (1.6, -0.2, 0.1, 1.0)


@awkward("a normal without length", words=("Mirror",))
def zero_normals(folder: Path) -> None:
    stage()
    mesh = find(MIRROR).data
    mesh.normals_split_custom_set_from_vertices([(0.0, 0.0, 0.0)] * len(mesh.vertices))


def _moved(offset: tuple[float, float, float]) -> None:
    scene = stage()
    for thing in scene.objects:
        thing.matrix_world = Matrix.Translation(offset) @ thing.matrix_world


@awkward("a kilometer from the origin")
def far_1e3(folder: Path) -> None:
    _moved((1e3, -1e3, 1e3))


@awkward("a hundred kilometers from the origin")
def far_1e5(folder: Path) -> None:
    _moved((1e5, -1e5, 0.0))


def _scaled(factor: float) -> None:
    scene: Any = stage()
    for thing in scene.objects:
        thing.matrix_world = Matrix.Scale(factor, 4) @ thing.matrix_world
    camera = scene.camera.data
    camera.clip_start, camera.clip_end = 0.01 * factor, 100.0 * factor


@awkward("a scene of a hundredth of a millimeter")
def small_1e5(folder: Path) -> None:
    _scaled(1e-5)


@awkward("a scene of millimeters")
def small_1e3(folder: Path) -> None:
    _scaled(1e-3)


@awkward("a scene of hundred kilometers")
def large_1e5(folder: Path) -> None:
    _scaled(1e5)


@awkward("units of the scene other than meters, which change nothing")
def units(folder: Path) -> None:
    scene = stage()
    scene.unit_settings.system, scene.unit_settings.scale_length = "IMPERIAL", 0.001


@awkward("a floor of a hundred kilometers")
def floor_huge(folder: Path) -> None:
    scene = stage()
    add_object("Plain", plane((1e5, 1e5)), matte("Plain", (0.05, 0.12, 0.03)), location=(0.0, 0.0, -0.05))
    scene.camera.data.clip_end = 1e6


@awkward("a thing of a hundred kilometers far away, and a grain near")
def sizes_mixed(folder: Path) -> None:
    scene = stage()
    add_ball("Moon", (-3e5, 6e5, 3e5), 1e5, matte("Moon", (0.7, 0.7, 0.6)))
    add_ball("Grain", (-0.3, -2.6, 0.06), 0.06, matte("Grain", (0.8, 0.3, 0.1)))
    scene.camera.data.clip_end = 1e7


@awkward("a thing flattened by its scale", words=("Red",))
def flattened(folder: Path) -> None:
    stage()
    find("Red").scale.x = 0.0


@awkward("a thing scaled to nothing")
def scaled_to_nothing(folder: Path) -> None:
    stage()
    find("Red").scale = (0.0, 0.0, 0.0)


@awkward("a mirror scaled to nothing", words=("Mirror",))
def mirror_scaled_to_nothing(folder: Path) -> None:
    stage()
    find(MIRROR).scale = (0.0, 0.0, 0.0)


@awkward("a mirror of a tenth of a millimeter in the usual scene")
def mirror_tiny(folder: Path) -> None:
    stage()
    find(MIRROR).scale = (1e-4, 1e-4, 1e-4)


@awkward("a mirror of fifty meters round everything: a room of mirrors", words=("bounce",))
def mirror_around(folder: Path) -> None:
    scene = stage()
    find(MIRROR).scale = (20.0, 20.0, 20.0)
    scene.cycles.max_bounces = 12


@awkward("a mirror out of view")
def mirror_out_of_view(folder: Path) -> None:
    stage()
    find(MIRROR).location = (0.0, -20.0, 1.0)


@awkward("a mirror that covers the whole picture")
def mirror_fills_picture(folder: Path) -> None:
    stage()
    find(MIRROR).location, find(MIRROR).scale = (0.0, 3.2, 1.5), (4.0, 4.0, 4.0)
