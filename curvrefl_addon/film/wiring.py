# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the joined picture goes into what the user composites: in place of the image of his Render Layers nodes."""

from __future__ import annotations

from typing import Any

import bpy

from ..engine.passes import MIRROR
from ..errors import InputError
from .joining import INSTANCES, NAME, joining_group

GAP = 40.0
_MARK = "curvrefl_film"
"""The nodes that are the film's have it, and what they are as its value"""
_KINDS = {"VALUE": "FLOAT", "VECTOR": "VECTOR", "RGBA": "RGBA"}
"""By the type of a pass, what a file has of it"""


def wire(
    scene: bpy.types.Scene,
    layer: bpy.types.ViewLayer,
    held_out: bpy.types.ViewLayer,
    mirrors: bpy.types.Scene,
    has_instances: bool,
) -> None:
    """Join `layer` of `scene`, its double, and what the scene `mirrors` renders, wherever the layer's image is used.

    Raises InputError where a compositor of the user's does not use it.
    """
    tree: Any = scene.compositing_node_group
    sources = _images_of(tree, scene, layer) if tree is not None else []
    if tree is None:
        tree = scene.compositing_node_group = _plain_tree(scene, layer)
        sources = _images_of(tree, scene, layer)
    if not sources:
        raise InputError(
            f'The compositor of scene "{scene.name}" does not use the image of view layer "{layer.name}":'
            " add its Render Layers node, or take the compositor away."
        )
    below = min(node.location.y for node in tree.nodes) - 300.0
    left = min(node.location.x for node in tree.nodes)
    apart = _render_layers(tree, scene, held_out, (left, below))
    ours = _render_layers(tree, mirrors, mirrors.view_layers[0], (left, below - 300.0))
    for source in sources:
        join = tree.nodes.new("CompositorNodeGroup")
        join.node_tree, join.name, join[_MARK] = joining_group(), NAME, "join"
        join.label = NAME
        join.location = (source.node.location.x + source.node.width + GAP, source.node.location.y)
        targets = [link.to_socket for link in source.links]
        tree.links.new(source, join.inputs["Image"])
        tree.links.new(apart.outputs["Image"], join.inputs["Held Out"])
        tree.links.new(ours.outputs[MIRROR], join.inputs["Mirror"])
        join.inputs[INSTANCES].default_value = float(has_instances)
        for target in targets:
            tree.links.new(join.outputs["Image"], target)


def unwire(scene: bpy.types.Scene) -> None:
    """Take the film's nodes out: what was joined is EEVEE's image again. A tree of the film's own goes altogether."""
    tree: Any = scene.compositing_node_group
    if tree is None:
        return
    for join in [node for node in tree.nodes if node.get(_MARK) == "join"]:
        given = join.inputs["Image"].links
        targets = [link.to_socket for link in join.outputs["Image"].links]
        for target in targets if given else ():
            tree.links.new(given[0].from_socket, target)
    for node in [node for node in tree.nodes if _MARK in node]:
        tree.nodes.remove(node)
    if _MARK in tree and len(tree.nodes) == 2:
        scene.compositing_node_group = None
        if not tree.users:
            bpy.data.node_groups.remove(tree)
    for group in [group for group in bpy.data.node_groups if group.get(NAME) and not group.users]:
        bpy.data.node_groups.remove(group)


def add_layers_file(scene: bpy.types.Scene, directory: str, name: str) -> None:
    """A File Output node: film, EEVEE, the held-out layer and our mirrors into one multilayer EXR file a frame."""
    tree: Any = scene.compositing_node_group
    join = next(node for node in tree.nodes if node.get(_MARK) == "join")
    ours = join.inputs["Mirror"].links[0].from_node
    layers = [
        ("Film", "RGBA", join.outputs["Image"]),
        ("EEVEE", "RGBA", join.inputs["Image"].links[0].from_socket),
        ("Held Out", "RGBA", join.inputs["Held Out"].links[0].from_socket),
        *(
            (item.name if item.name == MIRROR else f"{MIRROR} {item.name}", _KINDS[item.type], item)
            for item in _passes(ours)
        ),
    ]
    node = tree.nodes.new("CompositorNodeOutputFile")
    node[_MARK], node.label = "layers", f"{NAME}: Layers"
    node.location = (join.location.x + join.width + GAP, join.location.y - 300.0)
    node.directory, node.file_name = directory, name
    node.format.media_type = "MULTI_LAYER_IMAGE"
    node.format.file_format, node.format.color_depth = "OPEN_EXR_MULTILAYER", "32"
    for title, kind, _socket in layers:
        node.file_output_items.new(kind, title)
    for (_title, _kind, socket), target in zip(layers, node.inputs, strict=False):
        tree.links.new(socket, target)


def layers_files(scene: bpy.types.Scene) -> list[Any]:
    """The nodes that `add_layers_file` has made."""
    tree: Any = scene.compositing_node_group
    return [] if tree is None else [node for node in tree.nodes if node.get(_MARK) == "layers"]


def _passes(node: Any) -> list[Any]:
    return [socket for socket in node.outputs if socket.enabled and socket.name not in ("Image", "Alpha")]


def _images_of(tree: Any, scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> list[Any]:
    """Outputs that are the image of a scene's view layer and are used."""
    found = []
    for node in tree.nodes:
        if node.bl_idname == "CompositorNodeRLayers" and node.scene in (scene, None) and node.layer == layer.name:
            image = node.outputs["Image"]
            if image.is_linked and _MARK not in node:
                found.append(image)
    return found


def _render_layers(tree: Any, scene: Any, layer: Any, location: tuple[float, float]) -> Any:
    node = tree.nodes.new("CompositorNodeRLayers")
    node.scene, node.layer, node.location = scene, layer.name, location
    node[_MARK] = "layer"
    return node


def _plain_tree(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> Any:
    """As without a compositor."""
    tree: Any = bpy.data.node_groups.new(f"{NAME} of {scene.name}", "CompositorNodeTree")
    tree[_MARK] = True
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    node = _render_layers(tree, scene, layer, (0.0, 0.0))
    del node[_MARK]
    end = tree.nodes.new("NodeGroupOutput")
    end.location = (node.width + 300.0, 0.0)
    tree.links.new(node.outputs["Image"], end.inputs[0])
    return tree
