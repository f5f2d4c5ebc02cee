# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What time is charted against, and the scenes along each: of our own, or an open file's with less of something."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from ....errors import InputError
from ....optics.catalog import METHODS
from ....renderer.settings import Settings
from ....scene.arrays import SceneArrays
from ....scene.camera.view import View
from . import scenes
from .scenes import Size

DEFAULT_METHODS = ("auto", "exact", "secant_star", "newton", "environment_cube")
ALL = "all"
SCALES = (0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0)
"""Of the picture's sides"""
BOUNCES = (1, 2, 4, 8, 16)
ONE_MIRROR = "It shows no mirror in another, whatever number is asked for."


@dataclass(frozen=True, slots=True)
class Variant:
    """One place on an axis."""

    arrays: SceneArrays
    view: View
    amount: float | None
    """None: the mirrors' pixels, which are counted in the picture"""
    bounces: int = Settings().bounces


@dataclass(frozen=True, slots=True)
class Axis:
    """An amount that times are charted against."""

    name: str
    label: str
    """Of the chart's axis"""
    values: tuple[float, ...]
    """What `build` takes, ascending"""
    build: Callable[[float, Size], Variant]
    """The scene of a value, for a picture of so many pixels"""

    def refusal(self, method: str) -> str:
        """Why a method has no place on it, or nothing."""
        entry = METHODS[method]
        return ONE_MIRROR if self.name == "bounces" and not (entry.follows_rays or entry.chooses) else ""


def _triangles(value: float, size: Size) -> Variant:
    arrays, view = scenes.of_triangles(int(value), size)
    return Variant(arrays, view, scenes.triangles_of(arrays))


def _pixels(value: float, size: Size) -> Variant:
    return Variant(*scenes.of_pixels(value, size), None)


def _counted(build: Callable[[int, Size], tuple[SceneArrays, View]]) -> Callable[[float, Size], Variant]:
    return lambda value, size: Variant(*build(int(value), size), value)


def _image_sides(value: float, size: Size) -> Variant:
    return Variant(*scenes.of_image_sides(int(value), size), value * value)


def _bounces(value: float, size: Size) -> Variant:
    return Variant(*scenes.of_bounces(int(value), size), value, int(value))


AXES: dict[str, Axis] = {
    axis.name: axis
    for axis in (
        Axis("triangles", "triangles around the mirror", (1e3, 4e3, 16e3, 64e3, 256e3), _triangles),
        Axis("pixels", "mirror pixels", SCALES, _pixels),
        Axis("lights", "point lamps with shadows", (1, 2, 4, 8, 16, 32), _counted(scenes.of_lights)),
        Axis("images", "images", (1, 4, 16, 64), _counted(scenes.of_images)),
        Axis("image-size", f"texels of each of {scenes.IMAGES} images", (64, 256, 1024, 2048), _image_sides),
        Axis("mirrors", "mirrors", (1, 2, 4, 8, 16, 32), _counted(scenes.of_mirrors)),
        Axis("bounces", "mirrors one after the other", BOUNCES, _bounces),
    )
}
"""Of our own scenes"""

OF_FILES = ("pixels", "lights", "mirrors", "bounces")
"""What a file's scene can have less of, or more, and still be that scene"""


def chosen_axes(names: Sequence[str]) -> list[Axis]:
    """Those of our own scenes that are named."""
    return [AXES[name] for name in (AXES if ALL in names else names)]


def axes_of_file(names: Sequence[str], arrays: SceneArrays, view: View) -> list[Axis]:
    """Those named, in a scene that has been read: the picture's pixels, the first of its lamps and of its chosen
    mirrors, how often light goes from mirror to mirror. With ALL those of them that it has two of.

    Raises InputError for what cannot be varied there.
    """
    counts = {"lights": len(arrays.lights), "mirrors": len(arrays.reflectors)}
    for name in names:
        if name != ALL and name not in OF_FILES:
            raise InputError(
                f'"{name}" is varied in scenes of our own alone: name no file, or choose from {", ".join(OF_FILES)}.'
            )
        if name in counts and counts[name] < 2:
            raise InputError(f"The scene has too few {name} to chart time against them ({counts[name]}).")
    if ALL in names:
        names = [name for name in OF_FILES if counts.get(name, 2) >= 2]

    def first_lights(value: float, _size: Size) -> Variant:
        return Variant(replace(arrays, lights=arrays.lights[: int(value)]), view, value)

    def first_mirrors(value: float, _size: Size) -> Variant:
        return Variant(replace(arrays, reflectors=arrays.reflectors[: int(value)]), view, value)

    built: dict[str, tuple[tuple[float, ...], Callable[[float, Size], Variant]]] = {
        "pixels": (SCALES, lambda value, _size: Variant(arrays, scenes.resized(view, value), None)),
        "lights": (doubled(counts["lights"]), first_lights),
        "mirrors": (doubled(counts["mirrors"]), first_mirrors),
        "bounces": (BOUNCES, lambda value, _size: Variant(arrays, view, value, int(value))),
    }
    labels = {"lights": "lamps"}
    return [Axis(name, labels.get(name, AXES[name].label), *built[name]) for name in names]


def doubled(most: int) -> tuple[int, ...]:
    """1, 2, 4, .. and `most` itself."""
    return (*(1 << power for power in range(max(most - 1, 0).bit_length()) if 1 << power < most), most)
