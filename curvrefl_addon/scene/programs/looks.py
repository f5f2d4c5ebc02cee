# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked looks: images of a material's channels, drawn in place of a node tree that cannot be drawn as it is.

A look is an ordinary material of image textures in a Principled BSDF, which a custom property of the material points
to. It holds as long as the node tree is what it was.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import bpy

KEY = "curvrefl_look"
"""Custom property of a material: `material` (the look), `signature`, `images` by channel"""
UV_MAP = "Curvrefl Look"
"""Of the meshes that have the material"""
OUT_OF_DATE = "The baked look {of} is out of date: bake it again."
NO_UV_MAP = "Baked looks {of} are wrong, as they were baked for other objects: bake its materials again."
_BEYOND = (
    "A volume ",
    "Displacement ",
    "Holdout ",
    "Light that goes below ",
    "Ray portals ",
    "Shadows ",
    "The baked look ",
    "The pixels ",
    "Volumes ",
)
"""How causes of remarks begin for which a look does nothing"""
_NO_LOOK = frozenset(
    {
        "bl_description",
        "bl_icon",
        "bl_idname",
        "bl_label",
        "color",
        "height",
        "hide",
        "label",
        "location",
        "location_absolute",
        "name",
        "node_preview",
        "parent",
        "select",
        "show_options",
        "show_preview",
        "show_texture",
        "use_custom_color",
        "warning_propagation",
        "width",
    }
)
"""Properties of nodes that change no picture"""


@dataclass(frozen=True, slots=True)
class Look:
    """What was baked of a material."""

    material: bpy.types.Material
    """Stands for it"""
    images: Mapping[str, bpy.types.Image]
    """By what they hold: 'base_color', 'surface' (metallic, roughness, alpha), 'layers' (transmission, IOR level, coat
    weight), 'emission', 'normal'"""
    uv_map: str
    is_current: bool
    """The material's nodes are those that were baked"""


def look_of(material: bpy.types.Material) -> Look | None:
    """The material's look; None where none was baked, or what was is gone."""
    stored = material.original.get(KEY)
    if stored is None:
        return None
    try:
        stand_in, images, baked = stored["material"], stored["images"].to_dict(), str(stored["signature"])
    except (AttributeError, KeyError):
        return None
    if not isinstance(stand_in, bpy.types.Material) or any(image is None for image in images.values()):
        return None
    return Look(stand_in, images, UV_MAP, baked == signature(material.original.node_tree))


def may_help(cause: str) -> bool:
    """Whether a look shows what a remark of this cause says is not drawn."""
    return not cause.startswith(_BEYOND)


def signature(tree: bpy.types.NodeTree | None) -> str:
    """Changes when anything in the tree does that its picture depends on: of images, which they are."""
    if tree is None:
        return ""
    lines = sorted(_lines(tree, set()))
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def _lines(tree: Any, open_groups: set[int]) -> Iterator[str]:
    open_groups = open_groups | {tree.as_pointer()}
    for node in tree.nodes:
        yield f"{node.name}: {node.bl_idname} {_values(node, _NO_LOOK)}"
        for number, socket in enumerate(node.inputs):
            if hasattr(socket, "default_value"):
                yield f"{node.name} < {number}: {_text(socket.default_value)}"
        for number, socket in enumerate(node.outputs):
            if node.type in ("VALUE", "RGB", "NORMAL"):
                yield f"{node.name} > {number}: {_text(socket.default_value)}"
        group = getattr(node, "node_tree", None)
        if group is not None and group.as_pointer() not in open_groups:
            inner = hashlib.sha256("\n".join(sorted(_lines(group, open_groups))).encode()).hexdigest()
            yield f"{node.name} is {inner}"
    for link in tree.links:
        ends = (link.from_node.name, link.from_socket.identifier, link.to_node.name, link.to_socket.identifier)
        yield f"{ends} {link.is_muted}"
    for item in tree.interface.items_tree:
        if hasattr(item, "default_value"):
            yield f"interface {item.identifier}: {_text(item.default_value)}"


def _values(block: Any, left_out: frozenset[str] = frozenset({"name"})) -> str:
    """All settings of a node or of what belongs to it, by name."""
    found = []
    for item in block.bl_rna.properties:
        name = item.identifier
        if name in left_out or name == "rna_type" or name.startswith(("bl_", "inputs", "outputs", "internal_links")):
            continue
        value = getattr(block, name)
        if item.type == "COLLECTION":
            found.append(f"{name}={[_values(part) for part in value]}")
        elif item.type == "POINTER":
            found.append(f"{name}={_pointed(value)}")
        elif not item.is_readonly:
            found.append(f"{name}={_text(value)}")
    return ";".join(found)


def _pointed(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bpy.types.Image):
        space = value.colorspace_settings.name
        return _text(
            (value.name_full, value.filepath, value.source, value.alpha_mode, space, value.size[0], value.size[1])
        )
    if isinstance(value, bpy.types.ID):
        return str(value.name_full)
    return _values(value)


def _text(value: Any) -> str:
    if isinstance(value, str | int | float | bool) or value is None:
        return repr(value)
    if isinstance(value, bpy.types.ID):
        return str(value.name_full)
    try:
        return repr([_text(part) for part in value])
    except TypeError:
        return type(value).__name__
