# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that are none, or that single precision cannot compute with, out of what a scene says.

A file may hold NaN and infinity, by drivers and by damage. One of them in a picture spreads to all that it is averaged
with, so they are replaced where they are read, and a sentence says whose they were.
"""

from __future__ import annotations

import math
from dataclasses import fields, replace
from typing import Any

import numpy as np

from .arrays import Float32Array, Float64Array, ImageArrays, MaterialArrays, WorldArrays

LARGEST_LIGHT = 1e15
"""Of colors, strengths and powers: light has a few of them and the inverse square of a distance as factors, and its sum
must stay in single precision"""
LARGEST_POWER = 1e20
"""Of lamps, whose light thins out with the square of a scene's scale"""
LARGEST_COLOR = 6e4
"""Of what reflects: the product of a ray's mirrors is kept in half precision"""
LARGEST_PLACE = 1e12
"""Meters from the world's origin, and units from an object's: cubes of larger ones overflow in single precision"""


def is_usable(values: Any, largest: float = LARGEST_LIGHT) -> bool:
    """Whether numbers, any shape, are all finite and not too large."""
    array = np.asarray(values)
    # (A comparison with what is not a number is not true, and the least and the greatest of what has one are none.)
    return array.size == 0 or bool(array.min() >= -largest and array.max() <= largest)


def usable_pixels(pixels: Float32Array, largest: float = LARGEST_LIGHT) -> tuple[Float32Array, int]:
    """Pixels (h, w, channels), those that are not usable made black, and how many; the same array where all are."""
    if is_usable(pixels, largest):
        return pixels, 0
    bad = ~(np.abs(pixels) <= largest).all(axis=-1)
    result = pixels.copy()
    result[bad, :3] = 0.0
    result[bad, 3:] = 1.0
    return result, int(bad.sum())


def usable_material(material: MaterialArrays, notes: list[str]) -> MaterialArrays:
    """The material with its defaults for what is not usable, colors black; `notes` gets what that is."""
    plain = MaterialArrays("")
    largest = {
        **dict.fromkeys(("base_color", "specular_tint", "coat_tint", "transparent_tint"), LARGEST_COLOR),
        **dict.fromkeys(("metallic", "roughness"), 1e3),
        **dict.fromkeys(("ior", "coat_ior", "film_ior", "specular_level", "film_thickness"), 1e6),
        "anisotropic_rotation": 1e4,
    }
    changes: dict[str, Any] = {}
    for item in fields(MaterialArrays):
        value = getattr(material, item.name)
        if (
            item.name == "ranges"
            or not isinstance(value, (float, tuple))
            or is_usable(value, largest.get(item.name, LARGEST_LIGHT))
        ):
            continue
        is_color = item.name in ("base_color", "emission")
        changes[item.name] = (0.0, 0.0, 0.0) if is_color else getattr(plain, item.name)
        what = item.name.replace("_", " ")
        notes.append(f"The {what} {{of}} is not a usable number: {'black' if is_color else 'the default'} is drawn.")
    relief = material.relief
    if relief is not None and not is_usable(
        (relief.strength, relief.distance, *relief.uv_scale, *relief.uv_offset), LARGEST_PLACE
    ):
        changes["relief"] = None
        notes.append("Bumps {of} are left out: their strength is not a usable number.")
    return replace(material, **changes) if changes else material


def usable_image(image: ImageArrays, notes: list[str]) -> ImageArrays:
    """The image with black for pixels that are not usable."""
    pixels, count = usable_pixels(image.pixels)
    if count == 0:
        return image
    notes.append(f"Pixels of a texture {{of}} that are not usable numbers ({count}) are drawn black.")
    return replace(image, pixels=pixels)


def usable_world(world: WorldArrays, notes: list[str]) -> WorldArrays:
    """The world with black for what is not usable."""
    if not is_usable(world.color):
        notes.append("The color or strength {of} is not a usable number: black is drawn.")
        return WorldArrays()
    if world.image is None:
        return world
    pixels, count = usable_pixels(world.image, LARGEST_LIGHT / max(1.0, float(np.abs(world.color).max())))
    if count:
        notes.append(f"Pixels {{of}} that are not usable numbers ({count}) are drawn black.")
    if not is_usable(world.rotation):
        notes.append("The rotation {of} is not a usable number and left out.")
        return replace(world, image=pixels, rotation=np.eye(3))
    return world if pixels is world.image else replace(world, image=pixels)


def problem_of_place(matrix: Float64Array, reach: float) -> str:
    """Why nothing can be drawn where `matrix` (4, 4) puts what reaches so far from its origin; nothing where it can."""
    # A safe bound first, for scenes of thousands.
    if math.sqrt(float(np.vdot(matrix, matrix))) * (1.0 + reach) <= LARGEST_PLACE:
        return ""
    if not np.isfinite(matrix).all():
        return "is at no finite place"
    farthest = float(np.linalg.norm(matrix[:3, 3])) + reach * float(np.linalg.norm(matrix[:3, :3]))
    if not farthest <= LARGEST_PLACE:
        return f"lies farther out than {LARGEST_PLACE:.0e} m"
    return ""
