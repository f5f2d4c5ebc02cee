# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What of a film stays as EEVEE shows it, a sentence each."""

from __future__ import annotations

from typing import Any

import bpy

from .layers import filmed_layer, held_out_layer

MOST_NAMED = 3
"""Objects in a sentence"""
_CLEAR = ("ShaderNodeBsdfTransparent", "ShaderNodeBsdfGlass", "ShaderNodeBsdfRefraction")
_OPAQUE = {"Alpha": 1.0, "Transmission Weight": 0.0}
"""Inputs of a Principled BSDF that let no light through"""


def untold(scene: bpy.types.Scene, mirrors: list[bpy.types.Object]) -> tuple[list[str], bool]:
    """What stays EEVEE's, and whether there are mirrors that are only instances."""
    layer = filmed_layer(scene)
    instances = [obj.name for obj in mirrors if obj.name not in layer.objects]
    told = []
    if instances:
        names = ", ".join(f'"{name}"' for name in instances)
        told.append(
            f"{names}: only there as instances, which EEVEE cannot hold out: edges show its own reflection too."
        )
    others = [other.name for other in scene.view_layers if other.use and other not in (layer, held_out_layer(scene))]
    if others:
        names = ", ".join(f'"{name}"' for name in others)
        told.append(f'The film is of view layer "{layer.name}": {names} stay as EEVEE shows them.')
    if panes := [obj.name for obj in layer.objects if obj not in mirrors and _lets_through(obj)]:
        names = ", ".join(f'"{name}"' for name in panes[:MOST_NAMED])
        more = f" and {len(panes) - MOST_NAMED} more" if len(panes) > MOST_NAMED else ""
        told.append(f"Behind {names}{more} mirrors stay as EEVEE shows them: light goes through.")
    if scene.render.use_freestyle and layer.use_freestyle:
        told.append("Freestyle draws no lines over mirrors: these come into its picture.")
    return told, bool(instances)


def _lets_through(obj: Any) -> bool:
    """Whether what lies behind an object may be seen through it, by its nodes."""
    return any(
        slot.material is not None and slot.material.node_tree is not None and _is_clear(slot.material.node_tree, set())
        for slot in obj.material_slots
    )


def _is_clear(tree: Any, seen: set[int]) -> bool:
    if tree.session_uid in seen:
        return False
    seen.add(tree.session_uid)
    for node in tree.nodes:
        if node.bl_idname in _CLEAR:
            return True
        if node.type == "GROUP" and node.node_tree is not None and _is_clear(node.node_tree, seen):
            return True
        if node.bl_idname == "ShaderNodeBsdfPrincipled" and any(
            node.inputs[name].is_linked or node.inputs[name].default_value != value for name, value in _OPAQUE.items()
        ):
            return True
    return False
