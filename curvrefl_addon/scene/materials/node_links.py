# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the value of a node's input comes from: through reroutes, muted nodes and groups."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy

type Groups = tuple[Any, ...]
"""Group nodes one is inside of, outermost first"""

NUMBERS = ("VALUE", "INT", "BOOLEAN")
"""Types of sockets that hold one number"""


@dataclass(frozen=True, slots=True)
class Source:
    """The end of a chain of links."""

    socket: Any
    """An output of a node that makes the value, or an unlinked input whose `default_value` is it"""
    groups: Groups = ()

    @property
    def node(self) -> Any | None:
        """The node that makes the value; None for a plain value."""
        return self.socket.node if self.socket.is_output else None

    def input(self, name: str) -> Source:
        """Source of the node's input called `name` (its name or identifier)."""
        return source_of(find_input(self.socket.node, name), self.groups)

    def inputs(self) -> list[Source]:
        """Sources of all inputs that are in use, in order."""
        return [source_of(socket, self.groups) for socket in self.socket.node.inputs if socket.enabled]


def find_input(node: Any, name: str) -> Any:
    """The input called `name`; identifiers go before names, which are not unique. Raises KeyError."""
    for socket in node.inputs:
        if socket.identifier == name:
            return socket
    return node.inputs[name]


def source_of(socket: Any, groups: Groups = ()) -> Source:
    """Follow the links of an input. (Sockets of groups change nothing, whatever their kind: Cycles has no groups.)"""
    # Whose own value counts where the chain leads nowhere: the input it starts from, or that of a group it is in.
    own = Source(socket, groups)
    while not socket.is_output:
        links = _links_of(socket)
        if not links:
            return own
        socket = links[0].from_socket
        node = socket.node
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.mute:
            passed = next((link.from_socket for link in node.internal_links if link.to_socket == socket), None)
            # (Where nothing is plugged in that could pass, it is as if the muted node were not there.)
            if passed is None or not _links_of(passed):
                return own
            socket = passed
        elif node.type == "GROUP":
            inside = None if node.node_tree is None else _group_output(node.node_tree)
            if inside is not None:
                socket, groups = find_input(inside, socket.identifier), (*groups, node)
                own = Source(socket, groups)
        elif node.type == "GROUP_INPUT" and groups:
            socket, groups = find_input(groups[-1], socket.identifier), groups[:-1]
            own = Source(socket, groups)
    return Source(socket, groups)


def _links_of(socket: Any) -> list[Any]:
    """Those of an input that count."""
    return [link for link in socket.links if not link.is_muted and link.is_valid]


def output_source(tree: bpy.types.NodeTree | None, name: str) -> Source | None:
    """What is plugged into the input `name` of a material's or world's output, or None."""
    output: Any = None if tree is None else tree.get_output_node("CYCLES")
    if output is None:
        return None
    found = source_of(output.inputs[name])
    return found if found.node is not None else None


def _group_output(tree: Any) -> Any | None:
    outputs = [node for node in tree.nodes if node.type == "GROUP_OUTPUT"]
    return next((node for node in outputs if node.is_active_output), outputs[0] if outputs else None)
