# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user has chosen in the preferences, and what the settings of scenes and objects mean.

Light to import: the extension is enabled without its renderer.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

import bpy

from .diagnostics.colors import DiagnosticColors
from .scene.arrays import MaterialArrays
from .scene.opened.blend_file import SURFACE_TYPES, objects_of
from .setting import value_of
from .settings_table import OF_NEW_SCENES, OF_PREFERENCES, RENDERER, OwnPreferences, Settings

SETTINGS_VERSION = 1
"""Of `Scene.curvrefl`; a scene with a greater one was saved by a newer extension"""
PACKAGE = __package__.removesuffix(".curvrefl_addon")
"""The extension as Blender knows it, for instance bl_ext.user_default.curvrefl"""
_DEFAULTS = DiagnosticColors()


def _starts() -> dict[str, Any]:
    return {item.name: item.start for item in OF_NEW_SCENES}


@dataclass(frozen=True, slots=True)
class Options(OwnPreferences):
    """What the rest of the extension reads of them."""

    new_scenes: dict[str, Any] = field(default_factory=_starts)
    """By name, what settings of scenes start with"""
    colors: DiagnosticColors = field(default_factory=DiagnosticColors)


def current_options() -> Options:
    """The user's, or the defaults where the extension runs without being installed."""
    addon = bpy.context.preferences.addons.get(PACKAGE)
    chosen: Any = None if addon is None else addon.preferences
    if chosen is None:
        return Options()
    ramp = _DEFAULTS.ramp
    if not (_is_color(chosen.color_low, ramp[0]) and _is_color(chosen.color_high, ramp[-1])):
        # Of other ends the five stops of the default are not the way from one to the other.
        ramp = (_triple(chosen.color_low), _triple(chosen.color_high))
    return Options(
        **{item.name: value_of(chosen, item) for item in OF_PREFERENCES},
        new_scenes={item.name: value_of(chosen, item) for item in OF_NEW_SCENES},
        colors=DiagnosticColors(
            converged=_triple(chosen.color_converged),
            hidden=_triple(chosen.color_hidden),
            failed=_triple(chosen.color_failed),
            ramp=ramp,
        ),
    )


def _triple(color: Any) -> tuple[float, float, float]:
    red, green, blue = color
    return red, green, blue


def _is_color(color: Any, other: tuple[float, float, float]) -> bool:
    """Up to what properties round to."""
    return all(abs(one - two) < 1e-6 for one, two in zip(color, other, strict=True))


def newer_settings(scene: bpy.types.Scene) -> str:
    """A sentence for the user where the scene was saved by a newer extension, or nothing."""
    if scene.curvrefl.version <= SETTINGS_VERSION:
        return ""
    return "The file was saved with a newer Curvrefl: settings that this one does not know are left out. Update it."


def settings_of(chosen: Any, samples: int | None = None) -> Settings:
    """How to render by `Scene.curvrefl`; `samples` in place of its own."""
    settings = Settings(**{item.name: value_of(chosen, item) for item in RENDERER if item.panel})
    return settings if samples is None else replace(settings, samples=samples)


def marked_mirrors(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Objects of the scene that are marked as mirrors, also those that are only in a collection that is instanced."""
    return [item for item in objects_of(scene) if item.curvrefl.is_mirror and item.type in SURFACE_TYPES]


def mirrors_in(depsgraph: bpy.types.Depsgraph) -> list[bpy.types.Object]:
    """Objects marked as mirrors that a depsgraph shows, themselves or by instances, once each."""
    found: dict[int, bpy.types.Object] = {}
    for instance in depsgraph.object_instances:
        obj: Any = instance.object.original
        if instance.show_self and obj.curvrefl.is_mirror and obj.type in SURFACE_TYPES:
            found[obj.session_uid] = obj
    return list(found.values())


def filmed(scene: Any) -> Any:
    """The scene that a film's scene shows the mirrors of (see `film`), else the scene itself."""
    return scene.curvrefl.film_source or scene


def overrides_of(mirrors: Iterable[bpy.types.Object]) -> dict[int, MaterialArrays]:
    """By session_uid, the materials that mirrors' settings put in place of their own."""
    return {mirror.session_uid: material for mirror in mirrors if (material := _override_of(mirror)) is not None}


def _override_of(mirror: bpy.types.Object) -> MaterialArrays | None:
    settings = mirror.curvrefl
    if not settings.override:
        return None
    red, green, blue = settings.tint
    if settings.fresnel == "DIELECTRIC":
        return MaterialArrays("override", (0.0, 0.0, 0.0), roughness=0.0, ior=settings.ior)
    return MaterialArrays(
        "override", (red, green, blue), metallic=1.0, roughness=0.0, glossy_only=settings.fresnel == "CONSTANT"
    )
