# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of materials that shine with what a channel is: what Cycles bakes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import bpy

ONE, NOTHING = 1.0, 0.0
type Source = str | float
"""A socket's name, or a constant"""


@dataclass(frozen=True, slots=True)
class Kind:
    """What a shader node is in channels of a Principled BSDF."""

    base_color: Source = "Color"
    metallic: Source = NOTHING
    roughness: Source = ONE
    alpha: Source = ONE
    transmission: Source = NOTHING
    level: Source = NOTHING
    coat: Source = NOTHING
    emission: str = ""
    strength: Source = ONE


PRINCIPLED = Kind(
    "Base Color",
    "Metallic",
    "Roughness",
    "Alpha",
    "Transmission Weight",
    "Specular IOR Level",
    "Coat Weight",
    "Emission Color",
    "Emission Strength",
)
GLASS = Kind(roughness="Roughness", transmission=ONE, level=0.5)
KINDS = {
    "ShaderNodeBsdfPrincipled": PRINCIPLED,
    "ShaderNodeBsdfDiffuse": Kind(),
    "ShaderNodeBsdfAnisotropic": Kind(metallic=ONE, roughness="Roughness", level=0.5),
    "ShaderNodeBsdfMetallic": Kind("Base Color", metallic=ONE, roughness="Roughness", level=0.5),
    "ShaderNodeBsdfGlass": GLASS,
    "ShaderNodeBsdfRefraction": GLASS,
    "ShaderNodeBsdfTransparent": Kind(NOTHING, roughness=NOTHING, alpha=NOTHING),
    "ShaderNodeEmission": Kind(NOTHING, emission="Color", strength="Strength"),
}
"""By the node's type; others with a color are taken for diffuse"""
PARTS = {
    "base_color": ("base_color",),
    "surface": ("metallic", "roughness", "alpha"),
    "layers": ("transmission", "level", "coat"),
    "emission": ("emission", "strength"),
}
"""What each image holds"""


@dataclass(slots=True)
class Shaders:
    """The shader nodes of a material's surface, through groups."""

    found: list[tuple[Any, Kind]] = field(default_factory=list)
    bends_normals: bool = False

    @property
    def single(self) -> Any:
        """The one Principled BSDF that is all there is."""
        if len(self.found) == 1 and self.found[0][1] is PRINCIPLED:
            return self.found[0][0]
        return None

    def constant(self, name: str) -> float | None:
        """A channel's value where all shaders have the same; None where it may differ from place to place."""
        values = {_known(node, getattr(kind, name)) for node, kind in self.found}
        return values.pop() if len(values) == 1 else None

    def differs(self, image: str) -> bool:
        """Whether what the image would hold is not the same everywhere."""
        if image == "emission":
            shines = any(kind.emission for _, kind in self.found)
            node = self.single
            return shines and (node is None or any(node.inputs[name].is_linked for name in EMISSION))
        if image == "base_color":
            return self.single is None or bool(self.single.inputs["Base Color"].is_linked)
        return any(self.constant(name) is None for name in PARTS[image])


EMISSION = ("Emission Color", "Emission Strength")


def _known(node: Any, source: Source) -> float | None:
    if isinstance(source, float):
        return source
    socket = node.inputs[source]
    return None if socket.is_linked else float(socket.default_value)


def shaders_of(tree: Any) -> Shaders:
    """All that may be seen: of the whole tree, as what is not linked changes nothing."""
    shaders = Shaders()
    for node in _nodes(tree, set()):
        if _is_shader(node):
            shaders.found.append((node, kind_of(node)))
            shaders.bends_normals |= "Normal" in node.inputs and node.inputs["Normal"].is_linked
        if node.type == "OUTPUT_MATERIAL":
            shaders.bends_normals |= node.inputs["Displacement"].is_linked
    return shaders


def kind_of(node: Any) -> Kind:
    """See `KINDS`."""
    if node.bl_idname in KINDS:
        return KINDS[node.bl_idname]
    return Kind() if "Color" in node.inputs else Kind(NOTHING)


def _is_shader(node: Any) -> bool:
    makes = any(socket.type == "SHADER" and socket.is_linked for socket in node.outputs)
    return makes and node.type not in ("MIX_SHADER", "ADD_SHADER", "GROUP", "GROUP_INPUT", "REROUTE") and not node.mute


def _nodes(tree: Any, open_groups: set[int]) -> Iterator[Any]:
    for node in tree.nodes:
        yield node
        group = getattr(node, "node_tree", None)
        if group is not None and group.as_pointer() not in open_groups:
            yield from _nodes(group, open_groups | {tree.as_pointer()})


NOISY = frozenset({"AMBIENT_OCCLUSION", "BEVEL", "MATERIAL_RAYCAST"})
"""Types of nodes that follow rays: what comes of them takes samples"""


def is_noisy(tree: Any, is_for_normals: bool) -> bool:
    """Whether any such node is behind the tree's surface, or behind the normals and displacement alone."""
    ends = [node for node in tree.nodes if node.type == "OUTPUT_MATERIAL"]
    if not is_for_normals:
        return _has_noisy([socket for node in ends for socket in node.inputs], set())
    bent = [node.inputs["Normal"] for node in tree.nodes if "Normal" in node.inputs]
    return _has_noisy([*bent, *(node.inputs["Displacement"] for node in ends)], set())


def _has_noisy(sockets: list[Any], seen: set[int]) -> bool:
    for socket in sockets:
        for link in socket.links:
            node = link.from_node
            if node.as_pointer() in seen:
                continue
            seen.add(node.as_pointer())
            group = getattr(node, "node_tree", None)
            inside = group is not None and any(part.type in NOISY for part in _nodes(group, set()))
            if inside or node.type in NOISY or _has_noisy(list(node.inputs), seen):
                return True
    return False


class Shining:
    """A copy of a material that shines with what one image is to hold; `remove()` when done."""

    def __init__(self, material: bpy.types.Material, image: bpy.types.Image, holds: str) -> None:
        """`holds`: of `PARTS`, or 'normal': then the copy has the material's own shaders."""
        self.material: Any = material.copy()
        self._groups: list[bpy.types.NodeTree] = []
        tree: Any = self.material.node_tree
        if holds != "normal":
            # (Only where some of several shaders is not there, colors are weighted by what is.)
            self._convert(tree, holds, shaders_of(tree).single is None, {})
        self.is_noisy = is_noisy(tree, holds == "normal")
        """It takes samples"""
        target = tree.nodes.new("ShaderNodeTexImage")
        target.image = image
        for node in tree.nodes:
            node.select = node == target
        tree.nodes.active = target

    def remove(self) -> None:
        """Leave nothing behind."""
        bpy.data.materials.remove(self.material)
        for group in self._groups:
            bpy.data.node_groups.remove(group)

    def _convert(self, tree: Any, holds: str, is_weighted: bool, copies: dict[str, Any]) -> None:
        for node in list(tree.nodes):
            group = getattr(node, "node_tree", None)
            if group is not None:
                if group.name not in copies:
                    copy = copies[group.name] = group.copy()
                    self._groups.append(copy)
                    self._convert(copy, holds, is_weighted, copies)
                node.node_tree = copies[group.name]
            elif _is_shader(node):
                _replace(tree, node, kind_of(node), holds, is_weighted)


def _replace(tree: Any, node: Any, kind: Kind, holds: str, is_weighted: bool) -> None:
    """An emission in the place of a shader."""
    shines = tree.nodes.new("ShaderNodeEmission")
    if holds == "base_color":
        _feed(tree, node, kind.base_color, shines.inputs["Color"])
    elif holds == "emission":
        _feed(tree, node, kind.emission or NOTHING, shines.inputs["Color"])
        _feed(tree, node, kind.strength, shines.inputs["Strength"])
    else:
        combine = tree.nodes.new("ShaderNodeCombineColor")
        for name, socket in zip(PARTS[holds], combine.inputs, strict=True):
            _feed(tree, node, getattr(kind, name), socket)
        tree.links.new(combine.outputs[0], shines.inputs["Color"])
    if is_weighted and holds in ("base_color", "layers"):
        _feed(tree, node, kind.alpha, shines.inputs["Strength"])
    elif is_weighted and holds == "surface":
        # (Alpha itself is not weighted.)
        for number in (0, 1):
            _multiply(tree, node, kind.alpha, combine.inputs[number])
    for socket in [link.to_socket for link in node.outputs[0].links]:
        tree.links.new(shines.outputs[0], socket)


def _feed(tree: Any, node: Any, source: Source, to: Any) -> None:
    """What the node has there, or a constant."""
    if isinstance(source, float):
        to.default_value = (source,) * 3 + (1.0,) if to.type == "RGBA" else source
        return
    socket = node.inputs[source]
    if socket.is_linked:
        tree.links.new(socket.links[0].from_socket, to)
    else:
        value = socket.default_value
        to.default_value = value if to.type == socket.type else float(value)


def _multiply(tree: Any, node: Any, source: Source, socket: Any) -> None:
    """What goes into a socket, times what the node has there."""
    if source == ONE:
        return
    times = tree.nodes.new("ShaderNodeMath")
    times.operation = "MULTIPLY"
    if socket.is_linked:
        tree.links.new(socket.links[0].from_socket, times.inputs[0])
    else:
        times.inputs[0].default_value = socket.default_value
    _feed(tree, node, source, times.inputs[1])
    tree.links.new(times.outputs[0], socket)
