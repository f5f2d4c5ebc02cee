# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees in few words, and what varies over a tile to feed them with."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from .stage import MakeTree

type Value = float | tuple[float, ...] | MakeTree
"""Of an input: a constant, or what is plugged in"""


@dataclass(frozen=True, slots=True)
class Row:
    """A line of the table of nodes: a node in one of its modes, in a few trees."""

    node: str
    mode: str
    trees: tuple[MakeTree, ...]


def rows(node: str, *made: tuple[str, Iterable[MakeTree] | MakeTree]) -> list[Row]:
    """Rows of one node, by mode."""
    return [Row(node, mode, (trees,) if callable(trees) else tuple(trees)) for mode, trees in made]


def shader_node(
    kind: str,
    inputs: Mapping[str | int, Value] | None = None,
    output: str | int = 0,
    adjust: Callable[[Any], None] | None = None,
    **settings: Any,
) -> MakeTree:
    """A node ("Math" for ShaderNodeMath). Sockets are those in use by their name or place; `adjust` does the rest."""

    def make(tree: Any) -> Any:
        node = tree.nodes.new(f"ShaderNode{kind}")
        for name, value in settings.items():
            setattr(node, name, value)
        if adjust is not None:
            adjust(node)
        for name, value in (inputs or {}).items():
            socket = socket_of(node.inputs, name)
            if callable(value):
                tree.links.new(value(tree), socket)
            else:
                socket.default_value = value
        return socket_of(node.outputs, output)

    return make


def socket_of(sockets: Any, name: str | int) -> Any:
    """Of those in use."""
    used = [socket for socket in sockets if socket.enabled]
    if isinstance(name, int):
        return used[name]
    return {socket.name: socket for socket in reversed(used)}[name]


def attribute(name: str, output: str = "Factor", kind: str = "GEOMETRY") -> MakeTree:
    return shader_node("Attribute", output=output, attribute_name=name, attribute_type=kind)


ACROSS, UP = attribute("across"), attribute("up")
"""-2 to 2 over the tile"""
DAMP = attribute("damp")
"""-0.2 to 0.8 from below"""
WIND = attribute("wind", "Vector")
"""-1 to 1, and -1.5 to 1.5"""
PAINT, GLOW = attribute("Paint", "Color"), attribute("Glow", "Color")
"""0 to 1, and -0.1 to 1.5"""
PLACE = shader_node("TexCoord", output="Object")
"""Object space: about -1 to 1 in all axes"""
UV = shader_node("TexCoord", output="UV")
"""-0.35 to 1.45"""


def stepped(vector: MakeTree, step: float = 0.25) -> MakeTree:
    """The same everywhere in small cells, for what differs with the last bit of a coordinate."""
    return shader_node("VectorMath", {0: vector, 1: (step,) * 3}, operation="SNAP")


def split(vector: MakeTree, axis: str) -> MakeTree:
    return shader_node("SeparateXYZ", {0: vector}, axis)
