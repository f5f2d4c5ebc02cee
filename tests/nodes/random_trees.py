# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random node trees, each made by its seed alone.

Rounding differs between Cycles and the GPU in the last bits, and a chain of nodes may make anything of these. So trees
are tame: of what is large the sine goes on, what has poles is cut off, a node gets no input that is steeper than
`STEEPEST` allows, and steps are not made of what is flat (all of which could lie on an edge).
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .recipes import LEAVES, RECIPES, ROUGHLY_KNOWN, Recipe
from .stage import MakeTree

MOST_NODES = 20
STEEPEST = 2000.0
"""Of how much a value may change over a meter, for rounding errors of 1e-6 to stay below the tolerance"""
LARGEST = 4.0
"""Of any value that goes on"""


@dataclass(frozen=True, slots=True)
class Grown:
    """A value of the tree in the making."""

    socket: Any
    bound: float
    """Its absolute value is not greater"""
    steepness: float
    is_flat: bool = False
    """Here and there the same over an area"""


def random_tree(seed: int) -> MakeTree:
    """Of 3 to MOST_NODES nodes."""

    def make(tree: Any) -> Any:
        return Grower(random.Random(seed), tree).grow().socket

    return make


class Grower:
    """Adds nodes to a tree."""

    def __init__(self, chance: random.Random, tree: Any, depth: int = 0) -> None:
        self.chance = chance
        self.tree = tree
        self.depth = depth
        self.values: list[Grown] = []
        self.left = chance.randint(3, MOST_NODES if depth == 0 else 4)

    def grow(self) -> Grown:
        """The tree's value."""
        for name in self.chance.sample(sorted(LEAVES), 3):
            self.values.append(self.leaf(name))
        while self.left > 0:
            self.values.append(self.grown_in_group() if self.is_time_for_group() else self.grown())
        return self.joined()

    def joined(self) -> Grown:
        """All values that nothing was made of, added up."""
        loose = [value for value in self.values if not value.socket.links]
        result = loose[-1]
        for value in loose[:-1]:
            node = self.tree.nodes.new("ShaderNodeVectorMath")
            self.tree.links.new(result.socket, node.inputs[0])
            self.tree.links.new(value.socket, node.inputs[1])
            steepness = result.steepness + value.steepness
            result = Grown(node.outputs[0], result.bound + value.bound, steepness, result.is_flat or value.is_flat)
        return result

    def is_time_for_group(self) -> bool:
        return self.depth < 2 and self.left > 3 and self.chance.random() < 0.12

    def leaf(self, name: str) -> Grown:
        make, bound = LEAVES[name]
        return Grown(make(self.tree), bound, ROUGHLY_KNOWN.get(name, 1.0))

    def grown(self) -> Grown:
        """By one more node."""
        recipe = self.chance.choice(RECIPES)
        self.left -= 1
        node = self.tree.nodes.new(f"ShaderNode{recipe.kind}")
        for name, choices in recipe.settings.items():
            setattr(node, name, self.chance.choice(choices))
        if recipe.adjust is not None:
            recipe.adjust(node, self.chance)
        bound, steepness, is_flat = recipe.bound, 1.0, recipe.is_flat
        widest = 0.0
        sockets = [socket for socket in node.inputs if socket.enabled]
        linkable = [socket for socket in sockets if socket.name not in recipe.constants]
        always = self.chance.choice(linkable[:1] if recipe.has_steps else linkable) if linkable else None
        for socket in sockets:
            # (Two inputs of steps could be the same value, and all of it an edge.)
            given = self.plugged(socket, recipe, socket == always, not recipe.has_steps)
            if given is not None:
                steepness += given.steepness
                widest = max(widest, given.bound)
                is_flat |= given.is_flat
        outputs = [socket for socket in node.outputs if socket.enabled and socket.name not in recipe.not_judged]
        socket = self.chance.choice(outputs)
        if self.chance.random() < 0.05 and recipe.may_be_muted:
            node.mute = True
            bound = max(widest, LARGEST)
        grown = Grown(socket, bound, steepness * recipe.gain, is_flat)
        return self.tamed(grown, recipe.has_poles)

    def plugged(self, socket: Any, recipe: Recipe, always: bool, at_times: bool) -> Grown | None:
        """What is linked, or None where it is a constant."""
        low, high = recipe.ranges.get(socket.name, recipe.range)
        fitting = [
            value
            for value in self.values
            if value.steepness * recipe.gain < STEEPEST and not (recipe.has_steps and value.is_flat)
        ]
        may_be_linked = socket.name not in recipe.constants and fitting
        if may_be_linked and (always or socket.name in recipe.linked or (at_times and self.chance.random() < 0.6)):
            # (Rather the latest: long chains.)
            given = fitting[-1] if self.chance.random() < 0.5 else self.chance.choice(fitting)
            given = self.squeezed(given, recipe.ranges[socket.name]) if socket.name in recipe.ranges else given
            self.link(given.socket, socket)
            return given
        self.set_constant(socket, low, high)
        return None

    def set_constant(self, socket: Any, low: float, high: float) -> None:
        if socket.type in ("VALUE", "INT"):
            socket.default_value = self.chance.uniform(low, high)
        elif socket.type == "VECTOR":
            socket.default_value = [self.chance.uniform(low, high) for _ in range(3)]
        elif socket.type == "RGBA":
            socket.default_value = [*(self.chance.uniform(0.0, 1.0) for _ in range(3)), 1.0]

    def link(self, start: Any, end: Any) -> None:
        """At times through a reroute."""
        if self.chance.random() < 0.08:
            reroute = self.tree.nodes.new("NodeReroute")
            self.tree.links.new(start, reroute.inputs[0])
            start = reroute.outputs[0]
        self.tree.links.new(start, end)

    def squeezed(self, value: Grown, limits: tuple[float, float]) -> Grown:
        """A value within limits, for inputs that ask for too much elsewhere."""
        node = self.tree.nodes.new("ShaderNodeMapRange")
        node.inputs["From Min"].default_value, node.inputs["From Max"].default_value = -value.bound, value.bound
        node.inputs["To Min"].default_value, node.inputs["To Max"].default_value = limits
        self.tree.links.new(value.socket, node.inputs["Value"])
        ratio = (limits[1] - limits[0]) / max(2.0 * value.bound, 1e-3)
        return Grown(node.outputs["Result"], max(map(abs, limits)), value.steepness * ratio, value.is_flat)

    def tamed(self, value: Grown, has_poles: bool) -> Grown:
        """Cut off at poles, scaled down where it is large."""
        is_number = value.socket.type in ("VALUE", "INT")
        if has_poles:
            for operation, limit in (("MINIMUM", LARGEST), ("MAXIMUM", -LARGEST)):
                node = self.tree.nodes.new("ShaderNodeMath" if is_number else "ShaderNodeVectorMath")
                node.operation = operation
                node.inputs[1].default_value = limit if is_number else (limit,) * 3
                self.tree.links.new(value.socket, node.inputs[0])
                value = Grown(node.outputs[0], LARGEST, value.steepness, True)
        elif value.bound > LARGEST:
            node = self.tree.nodes.new("ShaderNodeMath" if is_number else "ShaderNodeVectorMath")
            node.operation = "SINE"
            self.tree.links.new(value.socket, node.inputs[0])
            value = Grown(node.outputs[0], 1.0, value.steepness, value.is_flat)
        return value

    def grown_in_group(self) -> Grown:
        """By a node group of a few nodes, which has two of the values as inputs."""
        import bpy

        group = bpy.data.node_groups.new("grown", "ShaderNodeTree")
        given = [self.chance.choice(self.values) for _ in range(2)]
        kinds = {"VALUE": "NodeSocketFloat", "INT": "NodeSocketFloat", "VECTOR": "NodeSocketVector"}
        for number, value in enumerate(given):
            kind = kinds.get(value.socket.type, "NodeSocketColor")
            group.interface.new_socket(f"In {number}", in_out="INPUT", socket_type=kind)
        group.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketColor")
        start, end = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
        inner = Grower(self.chance, group, self.depth + 1)
        inner.left = min(inner.left, self.left)
        self.left -= inner.left + 1
        inner.values = [
            Grown(start.outputs[number], value.bound, value.steepness, value.is_flat)
            for number, value in enumerate(given)
        ]
        result = inner.grow()
        group.links.new(result.socket, end.inputs["Out"])
        node = self.tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        for number, value in enumerate(given):
            self.link(value.socket, node.inputs[number])
        return self.tamed(Grown(node.outputs["Out"], result.bound, result.steepness, result.is_flat), False)


def random_trees(first: int, count: int) -> Mapping[str, MakeTree]:
    """By "seed N"."""
    return {f"seed {seed}": random_tree(seed) for seed in range(first, first + count)}
