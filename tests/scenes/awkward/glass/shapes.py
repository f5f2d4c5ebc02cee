# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Glass of shapes that glass does not have: without thickness, open, inside out, one in the other, round the eye."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..registry import MIRROR, awkward
from ..stage import EYE, add_ball, add_box, add_sheet, bpy, find, give, matte, stage, surface

SAMPLES = 256


def _scene(**kept: bool) -> None:
    stage(**kept)
    cycles = bpy.context.scene.cycles
    cycles.diffuse_bounces = 0
    cycles.sample_clamp_indirect = 0.0


def _glass(ior: float = 1.45, roughness: float = 0.0) -> bpy.types.Material:
    return surface("Glass", "BsdfGlass", Color=(0.95, 1.0, 0.95, 1.0), Roughness=roughness, IOR=ior)


@awkward("glass without thickness: one sheet that bends light and never back", samples=SAMPLES)
def glass_plane(folder: Path) -> None:
    _scene()
    add_sheet("Pane", (0.0, -2.6, 1.0), (2.0, 1.6), _glass(), (np.pi / 2.0, 0.0, 0.2))


@awkward("a chosen sheet of glass without thickness", mirrors=("Pane",), samples=SAMPLES)
def glass_plane_chosen(folder: Path) -> None:
    _scene(with_mirror=False)
    add_sheet("Pane", (0.0, -2.6, 1.0), (2.0, 1.6), _glass(), (np.pi / 2.0, 0.0, 0.2))


def _without_top(name: str) -> None:
    """Takes the upper third of a ball's faces away."""
    mesh = find(name).data
    highest = max(vertex.co.z for vertex in mesh.vertices)
    kept = [polygon for polygon in mesh.polygons if polygon.center.z < 0.4 * highest]
    corners = [list(polygon.vertices) for polygon in kept]
    positions = [tuple(vertex.co) for vertex in mesh.vertices]
    material = mesh.materials[0]
    mesh.clear_geometry()
    mesh.from_pydata(positions, [], corners, shade_flat=False)
    mesh.materials.clear()
    mesh.materials.append(material)


@awkward("an open bowl of glass without thickness", samples=SAMPLES)
def glass_open(folder: Path) -> None:
    _scene()
    give("Blue", _glass())
    _without_top("Blue")


@awkward("a chosen bowl of glass that is open", samples=SAMPLES)
def glass_open_chosen(folder: Path) -> None:
    _scene()
    give(MIRROR, _glass())
    _without_top(MIRROR)


@awkward("a glass ball whose normals look inward", samples=SAMPLES)
def glass_inside_out(folder: Path) -> None:
    _scene()
    give("Blue", _glass())
    find("Blue").data.flip_normals()


@awkward("a chosen glass ball whose normals look inward", samples=SAMPLES)
def glass_inside_out_chosen(folder: Path) -> None:
    _scene()
    give(MIRROR, _glass())
    find(MIRROR).data.flip_normals()


@awkward("a glass ball of negative scale", samples=SAMPLES)
def glass_mirrored(folder: Path) -> None:
    _scene()
    give("Blue", _glass())
    find("Blue").scale = (-1.0, 1.0, 1.0)


@awkward("the eye in a glass ball", samples=SAMPLES)
def camera_in_glass(folder: Path) -> None:
    _scene()
    add_ball("Helmet", EYE, 0.6, _glass(1.3))


@awkward("the eye in a chosen glass ball", mirrors=("Helmet", MIRROR), samples=SAMPLES)
def camera_in_chosen_glass(folder: Path) -> None:
    _scene()
    add_ball("Helmet", EYE, 0.6, _glass(1.3))


@awkward("the eye in a block that absorbs", words=("inside", "absor", "volume"), samples=SAMPLES)
def camera_in_absorbing(folder: Path) -> None:
    from ..stage import node, output_of

    _scene()
    material = surface("Water", "BsdfRefraction", Color=(1.0, 1.0, 1.0, 1.0), Roughness=0.0, IOR=1.0)
    absorb = node(material.node_tree, "VolumeAbsorption", Color=(0.2, 0.6, 0.9, 1.0), Density=0.3)
    material.node_tree.links.new(absorb.outputs[0], output_of(material.node_tree).inputs["Volume"])
    add_box("Water", EYE, (2.0, 2.0, 1.5), material, 0.0)


@awkward("64 shells of glass, one in the other", words=("bounce",), samples=SAMPLES)
def glass_shells(folder: Path) -> None:
    _scene()
    bpy.data.objects.remove(find("Blue"))
    for number in range(64):
        add_ball(f"Shell {number}", (-1.5, -1.3, 0.7), 0.7 - 0.01 * number, _glass(1.05), 24)


@awkward("64 chosen shells of glass, one in the other, and bounces for all", words=("bounce",), samples=32)
def glass_shells_chosen(folder: Path) -> None:
    _scene(with_mirror=False)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 64, 48
    scene.cycles.transmission_bounces = scene.cycles.max_bounces = 140
    for number in range(64):
        name = MIRROR if number == 0 else f"Shell {number}"
        add_ball(name, (0.0, 0.0, 1.0), 1.0 - 0.015 * number, _glass(1.02), 24)


@awkward("two blocks of glass a millimeter apart", samples=SAMPLES)
def glass_touching(folder: Path) -> None:
    _scene(things=False)
    add_box("First", (-1.5, -1.4, 0.52), (0.6, 0.6, 1.0), _glass(1.5), 0.0)
    add_box("Second", (-0.899, -1.4, 0.52), (0.6, 0.6, 1.0), _glass(1.5), 0.0)
    add_box("Behind", (-1.4, 0.2, 0.6), 0.6, matte("Behind", (0.7, 0.1, 0.05)))


@awkward("glass that cuts through a mirror", samples=SAMPLES)
def glass_through_mirror(folder: Path) -> None:
    _scene()
    add_box("Block", (0.7, -0.7, 1.0), (0.7, 0.7, 0.7), _glass(1.5))


@awkward("glass of one triangle's thickness far away", samples=SAMPLES)
def glass_needle(folder: Path) -> None:
    _scene()
    add_box("Needle", (0.0, -2.4, 1.0), (2.4, 1e-4, 1.2), _glass(1.5), 0.1)


@awkward("glass of no light: black", samples=SAMPLES)
def glass_black(folder: Path) -> None:
    _scene()
    give("Blue", surface("Black", "BsdfGlass", Color=(0.0, 0.0, 0.0, 1.0), Roughness=0.0, IOR=1.5))


@awkward("no transmission bounce: glass is black", words=("bounce",), samples=SAMPLES)
def bounces_no_transmission(folder: Path) -> None:
    _scene()
    give("Blue", _glass())
    bpy.context.scene.cycles.transmission_bounces = 0


@awkward("no transparent bounce: foils are black", words=("bounce",), samples=SAMPLES)
def bounces_no_transparent(folder: Path) -> None:
    _scene()
    give("Red", surface("Foil", "BsdfTransparent", Color=(0.9, 0.9, 0.5, 1.0)))
    bpy.context.scene.cycles.transparent_max_bounces = 0
