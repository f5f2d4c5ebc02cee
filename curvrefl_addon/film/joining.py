# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group that puts mirrors into a picture of EEVEE, scene-linear, before the view transform.

With E what EEVEE shows, H the same with the mirrors held out (both premultiplied), and C the color of our mirror alone:
EEVEE's own coverage of the mirrors is c = alpha(E) - alpha(H), after its depth of field and its motion blur, and

    joined = H + c C  where c > 0, else E, bit for bit.

H is nowhere divided by what is left of its alpha, so that a difference between EEVEE's and our samples leaves no
seam: on a plain background of color B, H is (1 - c) B. With M our mirror (premultiplied) and a its alpha, and both
blurred by some pixels as M~ and a~,

    C = (M + (1 - a) M~) / (a + (1 - a) a~),

which is M inside of mirrors, and where few of our sub-frames have met one not their noise alone. It is spread a little
beyond, for pixels that EEVEE's filter or its blur reaches alone. Mirrors that are only there as instances cannot be
held out: for them `Instances` takes our own coverage where it is more than EEVEE's.
"""

from __future__ import annotations

from typing import Any

import bpy

NAME = "Curvrefl Film"
LEAST_COVERAGE = 1.0 / 1024.0
"""Below it EEVEE's pixel stays: alpha has half precision"""
LEAST_WEIGHT = 1e-4
"""Of a color that was blurred: below it rounding tells"""
REACH = 0.01
"""How far colors of mirrors are spread, of the picture's greater side"""
LEAST_REACH = 3.0
"""In pixels"""
INPUTS = (("Image", "NodeSocketColor"), ("Held Out", "NodeSocketColor"), ("Mirror", "NodeSocketColor"))
INSTANCES = "Instances"


def joining_group() -> bpy.types.NodeTree:
    """The group of the open file, made where it is not there yet. Inputs `INPUTS` and `INSTANCES`, output Image."""
    for found in bpy.data.node_groups:
        if found.bl_idname == "CompositorNodeTree" and found.get(NAME) and found.library is None:
            return found
    group: Any = bpy.data.node_groups.new(NAME, "CompositorNodeTree")
    group[NAME] = True
    sockets: Any = group.interface
    for name, kind in INPUTS:
        sockets.new_socket(name, in_out="INPUT", socket_type=kind)
    flag = sockets.new_socket(INSTANCES, in_out="INPUT", socket_type="NodeSocketFloat")
    flag.description = "1 where mirrors are there only as instances, which cannot be held out"
    flag.min_value, flag.max_value = 0.0, 1.0
    sockets.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    _Builder(group).join()
    return group


class _Builder:
    """Nodes one after the other, from left to right."""

    def __init__(self, group: bpy.types.NodeTree) -> None:
        self._tree: Any = group
        self._column = 0

    def join(self) -> None:
        given = self._node("NodeGroupInput").outputs
        image, held_out, mirror, instances = given[0], given[1], given[2], given[3]
        whole, kept, found = (self._alpha(socket) for socket in (image, held_out, mirror))
        covered = self._math("MAXIMUM", self._math("SUBTRACT", whole, kept), 0.0)
        # As far as our own coverage goes beyond EEVEE's, of what that leaves.
        own = self._math("MULTIPLY", found, instances)
        total = self._math("MAXIMUM", covered, own)
        beyond = self._math("DIVIDE", self._math("SUBTRACT", total, covered), self._math("SUBTRACT", 1.0, covered))

        reach = self._reach(image)
        soft, rest = self._blurred(mirror, reach), self._math("SUBTRACT", 1.0, found)
        weight = self._math("MULTIPLY_ADD", self._alpha(soft), rest, found)
        color = self._vector("DIVIDE", self._vector("MULTIPLY_ADD", soft, rest, mirror), weight)
        is_found = self._math("GREATER_THAN", weight, LEAST_WEIGHT)
        spread = self._spread(self._with_alpha(color, is_found), reach)
        joined = self._vector("MULTIPLY_ADD", spread, covered, held_out)
        joined = self._mix(beyond, joined, spread)
        is_seen = self._math("GREATER_THAN", total, LEAST_COVERAGE)
        is_known = self._math("GREATER_THAN", self._alpha(spread), 0.5)
        chosen = self._mix(self._math("MULTIPLY", is_seen, is_known), image, joined)
        end = self._node("NodeGroupOutput")
        self._tree.links.new(self._with_alpha(chosen, whole), end.inputs[0])

    def _reach(self, image: Any) -> Any:
        size = self._node("CompositorNodeRelativeToPixel")
        size.data_type, size.reference_dimension = "FLOAT", "Greater"
        self._set(size.inputs["Float Value"], REACH)
        self._set(size.inputs["Image"], image)
        return self._math("MAXIMUM", size.outputs["Float Value"], LEAST_REACH)

    def _blurred(self, color: Any, reach: Any) -> Any:
        node = self._node("CompositorNodeBlur")
        self._set(node.inputs["Image"], color)
        self._set(node.inputs["Size"], reach)
        return node.outputs[0]

    def _spread(self, color: Any, reach: Any) -> Any:
        node = self._node("CompositorNodeInpaint")
        self._set(node.inputs["Image"], color)
        self._set(node.inputs["Size"], reach)
        return node.outputs[0]

    def _alpha(self, color: Any) -> Any:
        node = self._node("CompositorNodeSeparateColor")
        self._set(node.inputs[0], color)
        return node.outputs["Alpha"]

    def _with_alpha(self, color: Any, alpha: Any) -> Any:
        node = self._node("CompositorNodeSetAlpha")
        node.inputs["Type"].default_value = "Replace Alpha"
        self._set(node.inputs["Image"], color)
        self._set(node.inputs["Alpha"], alpha)
        return node.outputs[0]

    def _math(self, operation: str, *values: Any) -> Any:
        node = self._node("ShaderNodeMath")
        node.operation = operation
        for socket, value in zip(node.inputs, values, strict=False):
            self._set(socket, value)
        return node.outputs[0]

    def _vector(self, operation: str, *values: Any) -> Any:
        node = self._node("ShaderNodeVectorMath")
        node.operation = operation
        for socket, value in zip(node.inputs, values, strict=False):
            self._set(socket, value)
        return node.outputs["Vector"]

    def _mix(self, factor: Any, first: Any, second: Any) -> Any:
        node = self._node("ShaderNodeMix")
        node.data_type = "RGBA"
        by_name = {socket.identifier: socket for socket in node.inputs}
        for name, value in (("Factor_Float", factor), ("A_Color", first), ("B_Color", second)):
            self._set(by_name[name], value)
        return next(socket for socket in node.outputs if socket.identifier == "Result_Color")

    def _set(self, socket: Any, value: Any) -> None:
        if isinstance(value, bpy.types.NodeSocket):
            self._tree.links.new(value, socket)
        else:
            socket.default_value = value

    def _node(self, kind: str) -> Any:
        node = self._tree.nodes.new(kind)
        node.location = (180.0 * self._column, 0.0)
        self._column += 1
        return node
