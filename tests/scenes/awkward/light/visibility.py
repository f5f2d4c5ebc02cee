# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What rays of one kind see and others do not; bounces; shadows that are hard to get right."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import MIRROR, awkward
from ..stage import add_ball, add_box, add_lamp, add_object, add_sheet, emitter, find, matte, mirror, stage


@awkward("a thing that the camera does not see")
def invisible_to_camera(folder: Path) -> None:
    stage()
    find("Red").visible_camera = False


@awkward("a thing that mirrors do not see")
def invisible_to_glossy(folder: Path) -> None:
    stage()
    for name in ("Red", "Blue", "Green"):
        find(name).visible_glossy = False


@awkward("a thing without a shadow")
def invisible_to_shadow(folder: Path) -> None:
    stage()
    for name in ("Red", "Blue", "Green"):
        find(name).visible_shadow = False


@awkward("a thing that diffuse rays do not see")
def invisible_to_diffuse(folder: Path) -> None:
    stage()
    find("Red").visible_diffuse = False


@awkward("a mirror that the camera does not see", words=("camera", "Mirror"))
def mirror_invisible_to_camera(folder: Path) -> None:
    stage()
    find(MIRROR).visible_camera = False


@awkward("a mirror without a shadow")
def mirror_invisible_to_shadow(folder: Path) -> None:
    stage()
    find(MIRROR).visible_shadow = False


@awkward("a thing that is a hole in the picture", words=("holdout", "Red"))
def holdout(folder: Path) -> None:
    stage()
    find("Red").is_holdout = True


@awkward("a mirror that is a hole in the picture", words=("holdout", "Mirror"))
def holdout_mirror(folder: Path) -> None:
    stage()
    find(MIRROR).is_holdout = True


@awkward("a holdout in a transparent film", words=("holdout", "Red"))
def holdout_transparent(folder: Path) -> None:
    stage().render.film_transparent = True
    find("Red").is_holdout = True


@awkward("a floor that only catches shadows", words=("shadow catcher", "Floor"))
def shadow_catcher(folder: Path) -> None:
    stage().render.film_transparent = True
    find("Floor").is_shadow_catcher = True


@awkward("the world is not seen by the camera", words=("world",))
def world_invisible_to_camera(folder: Path) -> None:
    stage().world.cycles_visibility.camera = False


@awkward("the world is not seen in mirrors", words=("world",))
def world_invisible_to_glossy(folder: Path) -> None:
    stage().world.cycles_visibility.glossy = False


@awkward("the world gives no light to surfaces", words=("world",))
def world_invisible_to_diffuse(folder: Path) -> None:
    stage().world.cycles_visibility.diffuse = False


def _two_mirrors() -> Any:
    scene: Any = stage()
    add_ball("Second", (-1.1, -1.3, 0.7), 0.6, mirror("Chrome 2", (0.95, 0.8, 0.6)))
    return scene.cycles


@awkward("no bounce at all: mirrors are black", words=("bounce",))
def bounces_none(folder: Path) -> None:
    stage().cycles.max_bounces = 0


@awkward("no glossy bounce", words=("bounce",))
def bounces_no_glossy(folder: Path) -> None:
    stage().cycles.glossy_bounces = 0


@awkward("one glossy bounce between two mirrors", words=("bounce",), mirrors=(MIRROR, "Second"))
def bounces_one_glossy(folder: Path) -> None:
    _two_mirrors().glossy_bounces = 1


@awkward("two mirrors as Blender has them by default", mirrors=(MIRROR, "Second"))
def two_mirrors(folder: Path) -> None:
    _two_mirrors()


@awkward("Cycles' clamp of direct light", words=("clamp",))
def clamp_direct(folder: Path) -> None:
    stage().cycles.sample_clamp_direct = 0.4


@awkward("ambient occlusion in place of bounces", words=("fast global",))
def fast_gi(folder: Path) -> None:
    cycles: Any = stage().cycles
    cycles.use_fast_gi, cycles.fast_gi_method = True, "ADD"


@awkward("shadow terminator offset, as Blender sets it")
def low_poly_smooth(folder: Path) -> None:
    stage(sky=(0.05, 0.05, 0.06))
    add_ball("Coarse", (-0.9, -1.9, 0.6), 0.6, matte("Coarse", (0.7, 0.6, 0.2)), 8)


@awkward("cables: thin tubes under a sun")
def cables(folder: Path) -> None:
    stage(things=False)
    for number in range(8):
        x = -1.6 + 0.4 * number
        add_object(f"Cable {number}", _tube(0.02), matte(f"Cable {number}", (0.7, 0.6, 0.5)), True, (x, -1.8, 0.6))


def _tube(radius: float) -> Any:
    from curvrefl.curvrefl_addon.demo.shapes import tube

    t = np.linspace(0.0, 1.0, 40)
    path = np.stack([0.15 * np.sin(9.0 * t), 0.2 * np.cos(7.0 * t), 1.6 * t - 0.5], -1)
    return tube(path, np.full(40, radius), 8, (1.0, 0.3, 0.1))


@awkward("a dense lumpy mesh of 100,000 triangles under a sun")
def dense_shadows(folder: Path) -> None:
    from curvrefl.curvrefl_addon.demo.shapes import star_shape

    def radius(directions: Any) -> Any:
        x, y, z = (20.0 * directions).T
        return 0.8 + 0.03 * np.sin(x) * np.sin(y) * np.sin(z)

    stage(things=False)
    add_object("Lump", star_shape(radius, 92), matte("Lump", (0.7, 0.5, 0.3)), True, (-1.2, -1.6, 0.8))


@awkward("a low sun that grazes walls and a floor of small steps")
def grazing_sun(folder: Path) -> None:
    stage(sun=0.0, things=False)
    add_lamp("SUN", (4.0, -1.5, 0.5), 5.0, target=(0.0, 0.0, 0.0))
    for number in range(10):
        add_box(
            f"Step {number}",
            (-2.0 + 0.4 * number, -1.9, 0.03),
            (0.38, 0.9, 0.06),
            matte(f"S{number}", (0.6, 0.5, 0.4)),
            0.0,
        )


@awkward("a room lit through a window by the sun")
def room_with_window(folder: Path) -> None:
    stage()
    wall = matte("Wall", (0.15, 0.14, 0.13))
    add_box("Left", (2.9, 0.0, 1.5), (0.1, 8.0, 3.0), wall, 0.0)
    add_box("Back", (0.0, 2.9, 1.5), (6.0, 0.1, 3.0), wall, 0.0)
    add_box("Ceiling", (0.8, 0.0, 3.05), (4.4, 8.0, 0.1), wall, 0.0)


@awkward("a sheet just above the floor")
def near_contact(folder: Path) -> None:
    stage()
    add_sheet("Paper", (-0.6, -2.0, 0.002), (1.4, 1.0), matte("Paper", (0.8, 0.8, 0.75)), cells=(4, 4))


@awkward("a mirror that touches a wall and the floor")
def mirror_in_corner(folder: Path) -> None:
    stage()
    add_box("Wall", (0.0, 1.05, 1.5), (6.0, 0.1, 3.0), matte("Wall", (0.3, 0.1, 0.05)), 0.0)


@awkward("things that stick in the mirror")
def things_in_mirror(folder: Path) -> None:
    stage()
    add_box("Nail", (0.5, -0.8, 1.3), (0.3, 0.8, 0.3), matte("Nail", (0.8, 0.6, 0.1)), 0.4)


@awkward("an emitting wall seen by mirrors alone")
def emitter_for_mirrors(folder: Path) -> None:
    stage()
    card = add_sheet("Card", (-1.0, -4.0, 2.5), (2.0, 2.0), emitter("Card", (1.5, 1.4, 1.2)), (1.2, 0.0, 0.0))
    card.visible_camera = card.visible_diffuse = card.visible_shadow = False


@awkward("an object of a mesh light's collection that only lights", words=("emitter", "emission", "emit", "Card"))
def emitter_invisible(folder: Path) -> None:
    stage(sky=(0.02, 0.02, 0.03), sun=0.3)
    card = add_sheet("Card", (0.8, -2.4, 2.2), (1.5, 1.5), emitter("Card", (8.0, 6.0, 4.0)), (0.0, 0.0, 0.0))
    card.visible_camera = card.visible_glossy = False
