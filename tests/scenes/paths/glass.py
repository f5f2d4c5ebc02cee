# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Glass, as the chosen object and as scenery."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..awkward.stage import surface
from .registry import GLASS_LIMIT, OBJECT, path_scene
from .stage import (
    add_absorption,
    clear,
    metal,
    put_ball,
    put_box,
    put_lens,
    put_suzanne,
    put_teapot,
    put_wine_glass,
    room,
)

CHROME_BESIDE = "Chrome"


@path_scene("a glass ball", GLASS_LIMIT)
def glass_ball() -> None:
    room()
    put_ball(clear())


@path_scene("a ball of the Glass shader", GLASS_LIMIT)
def glass_shader() -> None:
    room()
    put_ball(surface("Glass", "BsdfGlass", Color=(0.9, 1.0, 0.92, 1.0), Roughness=0.0, IOR=1.5))


@path_scene("a ball of the Refraction shader", GLASS_LIMIT)
def refraction_shader() -> None:
    room()
    put_ball(surface("Refraction", "BsdfRefraction", Color=(1.0, 0.95, 0.9, 1.0), Roughness=0.0, IOR=1.33))


@path_scene("a glass pot", GLASS_LIMIT)
def glass_teapot() -> None:
    room()
    put_teapot(clear(Base_Color=(0.9, 0.97, 1.0, 1.0)))


@path_scene("a head of glass", GLASS_LIMIT)
def glass_suzanne() -> None:
    room()
    put_suzanne(clear())


@path_scene("a wine glass of two walls", GLASS_LIMIT)
def wine_glass() -> None:
    room(target=(0.0, 0.0, 0.95))
    put_wine_glass(clear(1.5), None)


@path_scene("a wine glass with a drink that reaches into its wall", GLASS_LIMIT, (OBJECT, "Drink"))
def wine_glass_filled() -> None:
    room(target=(0.0, 0.0, 0.95))
    drink = clear(1.33)
    add_absorption(drink, (0.9, 0.15, 0.2), 2.0)
    put_wine_glass(clear(1.5), drink)


@path_scene("a window pane of two sides", GLASS_LIMIT)
def window_solid() -> None:
    room()
    put_box(clear(1.5, Base_Color=(0.85, 1.0, 0.9, 1.0)), (2.2, 0.06, 1.8), (0.0, -0.6, 1.0), turn=0.4)


@path_scene("a window pane of one side, thin-walled", GLASS_LIMIT)
def window_thin() -> None:
    from curvrefl.curvrefl_addon.demo.data_blocks import add_object
    from curvrefl.curvrefl_addon.demo.shapes import plane

    room()
    material = clear(1.5, Base_Color=(0.85, 1.0, 0.9, 1.0))
    make_thin(material)
    add_object(OBJECT, plane((2.2, 1.8)), material, location=(0.0, -0.6, 1.0), rotation=(np.pi / 2.0, 0.0, 0.4))


def make_thin(material: Any) -> None:
    """Sets what this Blender calls a thin wall of the Principled BSDF."""
    shader = next(item for item in material.node_tree.nodes if item.type == "BSDF_PRINCIPLED")
    shader.inputs["Thin Wall"].default_value = True


@path_scene("a thin-walled ball: a soap bubble", GLASS_LIMIT)
def bubble() -> None:
    room()
    material = clear(1.33)
    make_thin(material)
    put_ball(material)


@path_scene("a ball of glass of roughness 0.2", GLASS_LIMIT)
def rough_glass_02() -> None:
    room()
    put_ball(clear(roughness=0.2))


@path_scene("a ball of glass of roughness 0.5", GLASS_LIMIT)
def rough_glass_05() -> None:
    room()
    put_ball(clear(roughness=0.5))


@path_scene("frosted glass before a wall: a slab of roughness 0.3", GLASS_LIMIT)
def frosted_slab() -> None:
    room()
    put_box(clear(1.5, 0.3), (2.2, 0.12, 1.8), (0.0, -0.4, 1.0), turn=0.3)


@path_scene("a lens that enlarges", GLASS_LIMIT)
def magnifier() -> None:
    room()
    put_lens(clear(1.5), (0.0, -1.4, 1.25), 0.75, 0.18)


@path_scene("a block that absorbs", GLASS_LIMIT)
def absorbing_block() -> None:
    room()
    material = surface("Resin", "BsdfGlass", Color=(1.0, 1.0, 1.0, 1.0), Roughness=0.0, IOR=1.4)
    add_absorption(material, (0.95, 0.55, 0.15), 1.6)
    put_box(material, (1.6, 1.1, 1.5), (0.0, 0.0, 0.76), turn=0.5)


@path_scene("glass in glass: four shells, one in the other", GLASS_LIMIT)
def nested_shells() -> None:
    room()
    for number in range(4):
        put_ball(clear(1.2 + 0.1 * number), OBJECT if number == 0 else f"Shell {number}", radius=1.0 - 0.2 * number)


@path_scene("air in glass: a hollow ball", GLASS_LIMIT)
def hollow_ball() -> None:
    from curvrefl.curvrefl_addon.demo.shapes import Shape, ball, joined

    room()
    inner = ball(0.85, 96)
    turned = Shape(inner.positions, tuple(polygon[::-1] for polygon in inner.polygons))
    from curvrefl.curvrefl_addon.demo.data_blocks import add_object

    outer = ball(1.0, 96)
    both = joined(Shape(outer.positions, outer.polygons), turned)
    add_object(OBJECT, both, clear(1.5), smooth=True, location=(0.0, 0.0, 1.0))


@path_scene("glass in a chrome mirror", (None, 0.03), (CHROME_BESIDE,))
def glass_in_chrome() -> None:
    room()
    put_ball(metal(0.0), CHROME_BESIDE, (0.0, 0.4, 1.0))
    put_ball(clear(), "Marble", (-0.7, -1.0, 0.4), 0.4, 64)
    put_box(clear(1.5, Base_Color=(0.5, 0.9, 0.6, 1.0)), (0.5, 0.5, 0.8), (0.7, -1.1, 0.41), "Brick", 0.5)


@path_scene("glass beside a chrome mirror, seen directly", (None, 0.03), (CHROME_BESIDE,), ("Marble", "Brick"))
def glass_beside_chrome() -> None:
    glass_in_chrome()


@path_scene("a chosen ball of glass beside a chosen ball of chrome", GLASS_LIMIT, (CHROME_BESIDE, OBJECT))
def glass_and_chrome() -> None:
    room()
    put_ball(metal(0.0), CHROME_BESIDE, (-0.8, 0.3, 0.75), 0.75)
    put_ball(clear(), OBJECT, (0.7, -0.5, 0.65), 0.65)


@path_scene("half transmission over a color, roughness 0.2")
def half_transmission() -> None:
    room()
    put_ball(clear(1.5, 0.2, Base_Color=(0.9, 0.4, 0.2, 1.0), Transmission_Weight=0.5))


@path_scene("a diamond: flat faces of a high index")
def diamond() -> None:
    from curvrefl.curvrefl_addon.demo.data_blocks import add_object
    from curvrefl.curvrefl_addon.demo.shapes import turned_profile

    room()
    profile = [(0.0, 0.1), (0.95, 1.05), (0.95, 1.12), (0.6, 1.5), (0.0, 1.5)]
    add_object(OBJECT, turned_profile(profile, 12), clear(2.4), location=(0.0, 0.0, 0.2))
