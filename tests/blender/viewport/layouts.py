# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stands in for the layout and the context that Blender gives to panels."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import bpy


class Layout:
    """Takes what a draw function puts into a layout; every property must be there."""

    def __init__(self, root: Layout | None = None) -> None:
        self.root = root or self
        self.texts: list[str] = []
        self.shown: list[str] = []

    def __getattr__(self, _name: str) -> Any:
        return self._nested

    def _nested(self, *_arguments: Any, **_keywords: Any) -> Layout:
        return Layout(self.root)

    def prop(self, owner: Any, name: str, text: str | None = None, **_keywords: Any) -> None:
        assert name in owner.bl_rna.properties, name
        self.root.shown.append(name)
        if text:
            self.root.texts.append(text)

    def label(self, text: str = "", icon: str = "NONE") -> None:
        assert icon in bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items
        self.root.texts.append(text)

    def operator(self, name: str, text: str | None = None, **_keywords: Any) -> SimpleNamespace:
        group, _, verb = name.partition(".")
        assert getattr(getattr(bpy.ops, group), verb).get_rna_type().properties is not None
        self.root.shown.append(name)
        return SimpleNamespace()

    def menu(self, name: str, text: str = "", **_keywords: Any) -> None:
        assert hasattr(bpy.types, name), name
        self.root.texts.append(text)


def context(**changed: Any) -> Any:
    region = SimpleNamespace(width=300)
    # Without a window Blender's interface scale is 0.
    scale = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0))
    view = {name: getattr(bpy.context, name) for name in ("scene", "object", "window_manager", "view_layer")}
    return SimpleNamespace(**(view | {"preferences": scale, "region": region} | changed))


def draw(cls: Any, seen: Any) -> Layout | None:
    """The panel's header, preset and body into one layout; None where it does not apply."""
    if hasattr(cls, "poll") and not cls.poll(seen):
        return None
    layout = Layout()
    for part in ("draw_header", "draw_header_preset", "draw"):
        # Called as plain functions: Blender alone makes instances of panels.
        if (function := cls.__dict__.get(part)) is not None:
            function(SimpleNamespace(layout=layout), seen)
    return layout


def add_cubes(count: int) -> list[bpy.types.Object]:
    for number in range(count):
        bpy.ops.mesh.primitive_cube_add(location=(3.0 * number, 0.0, 0.0))
    cubes = [item for item in bpy.context.scene.objects if item.type == "MESH"]
    for cube in cubes:
        cube.select_set(True)
    bpy.context.view_layer.objects.active = cubes[0]
    return cubes
