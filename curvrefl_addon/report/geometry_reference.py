# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""What each mirror pixel shows in Cycles, as a world position and an object, free of noise.

One material overrides all others in the view layer. It emits the world position (or the object's id); on the
reflectors, and there for camera rays only, it is a white mirror without roughness or bumps, about Cycles' own
shading normal. The world emits the ray's direction. With the pixel filter shrunk to the center, one sample is exact.
Emission keeps negative values and is not clamped, so the numbers come out in single precision as they are.
A mirror that is seen in a mirror counts as the point of it that is hit.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Literal

import bpy
import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..scene.arrays import Float32Array, Int32Array
from ..scene.opened.temporary_settings import TemporarySettings, temporary_settings
from .cycles_reference import cycles_settings, render_still, use_cycles, use_pinhole, use_still_output

UNLISTED_OBJECT = -1
"""The id of objects that were not given one"""

_MOST_OBJECTS = 32766  # Blender's pass index ends at 32767, and one stands for the unlisted.

# What the third channel of the object pass says of a path.
_SURFACE = 1.0
_BACKGROUND = 2.0

_PIXEL_FILTER_WIDTH = 0.01
_UNSEEN_TYPES = ("LIGHT", "LIGHT_PROBE", "GREASEPENCIL", "VOLUME", "SPEAKER")


@dataclass(frozen=True, slots=True)
class GeometryReference:
    """Per pixel, at its center (to 0.005 of a pixel), row 0 at the BOTTOM."""

    mask: Int32Array
    """(h, w) object id of the reflector, 0 elsewhere"""
    reflector_position: Float32Array
    """(h, w, 3) world point of the reflector, 0 outside the mask"""
    reflected_position: Float32Array
    """(h, w, 4) what the reflector shows: world point, w = 1, or unit direction of the background, w = 0; 0 where
    not `valid`"""
    reflected_object: Int32Array
    """(h, w) object id of it, 0 background"""
    valid: NDArray[np.bool_]
    """(h, w) mask pixels in which Cycles followed the reflection; at grazing angles it may drop the path, because
    the ray that the shading normal reflects runs into the facet"""


def render_geometry(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    width: int,
    height: int,
    object_ids: Mapping[str, int],
    reflector_ids: Collection[int],
) -> GeometryReference:
    """Render the four passes in Cycles (one sample each).

    `object_ids`: object name to id (positive), as in `SceneArrays.instances`; instances carry the id of the object
    that they show. Everything is restored afterwards. Raises InputError for more objects than Blender can tell apart.
    """
    # Pass indices: the reflectors first (so that the shader can tell them), then one for all unlisted objects.
    ids_by_index = [0, *sorted(set(reflector_ids)), UNLISTED_OBJECT]
    last_reflector = len(ids_by_index) - 2
    ids_by_index += sorted(set(object_ids.values()) - set(ids_by_index))
    if len(ids_by_index) > _MOST_OBJECTS + 1:
        raise InputError(
            f"The scene has {len(ids_by_index)} objects and Blender's pass index tells only {_MOST_OBJECTS} apart: "
            "hide or join objects before comparing."
        )
    id_of_index = np.array(ids_by_index, np.int32)
    index_of_id = {number: index for index, number in enumerate(ids_by_index)}
    with temporary_settings() as changes:
        use_still_output(changes, scene, width, height)
        use_pinhole(changes, scene)
        use_cycles(changes, scene, view_layer, 1, "direct")
        changes.set(cycles_settings(scene), pixel_filter_type="BLACKMAN_HARRIS", filter_width=_PIXEL_FILTER_WIDTH)
        for obj in bpy.data.objects:
            changes.set(obj, pass_index=index_of_id[object_ids.get(obj.name, UNLISTED_OBJECT)])
            if obj.type in _UNSEEN_TYPES:
                changes.set(obj, hide_render=True)

        def shoot(what: Literal["position", "object"], mirrors: bool) -> Float32Array:
            changes.set(
                view_layer,
                material_override=_override_material(changes, what, last_reflector if mirrors else 0),
                world_override=_override_world(changes, what),
            )
            return render_still(scene, view_layer).pixels[..., :3]

        seen_object = shoot("object", mirrors=False)
        seen_position = shoot("position", mirrors=False)
        shown_object = shoot("object", mirrors=True)
        shown_position = shoot("position", mirrors=True)

    seen = id_of_index[np.rint(seen_object[..., 0]).astype(np.int32)]
    mask = np.where(np.isin(seen, list(reflector_ids)), seen, 0).astype(np.int32)
    on_mirror = mask != 0
    is_point = on_mirror & (shown_object[..., 2] == _SURFACE)
    valid = is_point | (on_mirror & (shown_object[..., 2] == _BACKGROUND))
    shown = id_of_index[np.rint(shown_object[..., 0]).astype(np.int32)]
    return GeometryReference(
        mask=mask,
        reflector_position=np.where(on_mirror[..., None], seen_position, 0.0).astype(np.float32),
        reflected_position=np.concatenate(
            (np.where(valid[..., None], shown_position, 0.0), is_point[..., None]), axis=2, dtype=np.float32
        ),
        reflected_object=np.where(is_point, shown, 0).astype(np.int32),
        valid=valid,
    )


def _override_material(
    changes: TemporarySettings, what: Literal["position", "object"], last_mirror: int
) -> bpy.types.Material:
    """Emits `what`; objects of pass index 1 .. `last_mirror` are mirrors where the camera sees them."""
    material = changes.remove_at_end(bpy.data.materials, bpy.data.materials.new("curvrefl geometry"))
    material.cycles.emission_sampling = "NONE"
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    emission = tree.nodes.new("ShaderNodeEmission")
    info = tree.nodes.new("ShaderNodeObjectInfo")
    if what == "object":
        mark = tree.nodes.new("ShaderNodeCombineXYZ")
        mark.inputs["Z"].default_value = _SURFACE
        tree.links.new(info.outputs["Object Index"], mark.inputs["X"])
        tree.links.new(mark.outputs["Vector"], emission.inputs["Color"])
    else:
        geometry = tree.nodes.new("ShaderNodeNewGeometry")
        tree.links.new(geometry.outputs["Position"], emission.inputs["Color"])
    if last_mirror == 0:
        tree.links.new(emission.outputs["Emission"], output.inputs["Surface"])
        return material

    mirror = tree.nodes.new("ShaderNodeBsdfAnisotropic")  # the Glossy BSDF
    mirror.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    mirror.inputs["Roughness"].default_value = 0.0
    is_mirror = tree.nodes.new("ShaderNodeMath")
    is_mirror.operation = "LESS_THAN"
    is_mirror.inputs[1].default_value = last_mirror + 0.5
    light_path = tree.nodes.new("ShaderNodeLightPath")
    seen_mirror = tree.nodes.new("ShaderNodeMath")
    seen_mirror.operation = "MULTIPLY"
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(info.outputs["Object Index"], is_mirror.inputs[0])
    tree.links.new(is_mirror.outputs["Value"], seen_mirror.inputs[0])
    tree.links.new(light_path.outputs["Is Camera Ray"], seen_mirror.inputs[1])
    tree.links.new(seen_mirror.outputs["Value"], mix.inputs[0])
    tree.links.new(emission.outputs["Emission"], mix.inputs[1])
    tree.links.new(mirror.outputs["BSDF"], mix.inputs[2])
    tree.links.new(mix.outputs["Shader"], output.inputs["Surface"])
    return material


def _override_world(changes: TemporarySettings, what: Literal["position", "object"]) -> bpy.types.World:
    world = changes.remove_at_end(bpy.data.worlds, bpy.data.worlds.new("curvrefl geometry"))
    world.cycles.sampling_method = "NONE"
    tree = world.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputWorld")
    background = tree.nodes.new("ShaderNodeBackground")
    background.inputs["Strength"].default_value = 1.0
    tree.links.new(background.outputs["Background"], output.inputs["Surface"])
    if what == "object":
        background.inputs["Color"].default_value = (0.0, 0.0, _BACKGROUND, 1.0)
    else:
        # In a world shader the position is the ray's unit direction.
        geometry = tree.nodes.new("ShaderNodeNewGeometry")
        tree.links.new(geometry.outputs["Position"], background.inputs["Color"])
    return world
