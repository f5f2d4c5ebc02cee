# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain values of all kinds, menus, and nodes that are not drawn as they are: each with one remark."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ....materials.node_links import Source
from ...builder import Builder, Handler
from ...expression import Expression, Kind
from .surface import normal_input

_KINDS: Mapping[str, Kind] = {"RGBA": "color", "VECTOR": "vector"}
"""By a socket's type; all others are numbers"""


def _kind(socket: Any) -> Kind:
    return _KINDS.get(socket.type, "float")


def _plain(attribute: str) -> Handler:
    """A handler of a node that holds one number, or three."""

    def handler(b: Builder, source: Source) -> Expression:
        value = getattr(source.node, attribute)
        return b.parameter(float(value)) if isinstance(value, int | float) else b.parameter(*tuple(value)[:3])

    return handler


def _conversion(b: Builder, source: Source) -> Expression:
    """Implicit Conversion: to the kind of its output."""
    found = b.value(source.input("Value"), _kind(source.node.inputs["Value"]))
    return b.as_kind(found, _kind(source.socket))


def _menu_switch(b: Builder, source: Source) -> Expression | None:
    node: Any = source.node
    menu = source.input("Menu")
    chosen = menu.node.value if menu.node is not None and menu.node.bl_idname == "FunctionNodeInputMenu" else None
    if menu.node is None:
        chosen = menu.socket.default_value
    names = [item.name for item in node.enum_definition.enum_items]
    if chosen not in names:
        return None
    item = node.inputs[1 + names.index(chosen)]
    if source.socket.identifier != "Output":
        return b.parameter(float(source.socket.identifier == item.identifier))
    return b.input(source, item.identifier, _kind(source.socket))


def _occlusion(b: Builder, source: Source) -> Expression:
    b.note("Ambient Occlusion nodes {of} are drawn as if nothing were near.")
    return b.input(source, "Color", "color") if source.socket.identifier == "Color" else b.parameter(1.0)


def _bevel(b: Builder, source: Source) -> Expression:
    b.note("Edges of Bevel nodes {of} stay sharp.")
    return normal_input(b, source)


def _zeros(cause: str) -> Handler:
    """A handler of a node whose outputs are drawn as 0."""

    def handler(b: Builder, source: Source) -> Expression:
        b.note(cause)
        kind = _kind(source.socket)
        return b.as_kind(b.parameter(0.0), kind)

    return handler


NODES: Mapping[str, Handler] = {
    "INPUT_BOOL": _plain("boolean"),
    "INPUT_INT": _plain("integer"),
    "INPUT_VECTOR": _plain("vector"),
    "NodeImplicitConversion": _conversion,
    "MENU_SWITCH": _menu_switch,
    "AMBIENT_OCCLUSION": _occlusion,
    "BEVEL": _bevel,
    "WIREFRAME": _zeros("Wires of Wireframe nodes {of} are not drawn."),
    "MATERIAL_RAYCAST": _zeros("Rays of Raycast nodes {of} hit nothing."),
    "PARTICLE_INFO": _zeros("Particle Info nodes {of} are drawn as 0."),
    "VOLUME_INFO": _zeros("Volume Info nodes {of} are drawn as 0."),
}
