# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes the look of one material, step by step."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ...curvrefl_addon.errors import InputError
from ...curvrefl_addon.scene.programs.looks import KEY, UV_MAP, look_of, signature
from .channels import PARTS, Shaders, Shining, shaders_of
from .stand_in import stand_in
from .unwrap import add_maps, remove_maps

MARGIN = 8
"""Pixels around islands"""
NON_COLOR = "Non-Color"
LEAST_SAMPLES = 8
"""Of what is not noisy: they smooth edges within pixels"""


@dataclass(frozen=True, slots=True)
class Step:
    """One of the images."""

    number: int
    count: int
    holds: str


def bake_look(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    material: Any,
    resolution: int,
    samples: int,
) -> Iterator[Step]:
    """Bake an image at each step, and after the last one let the look stand for the material.

    Between steps the file is as it was but for new images and UV maps; what a closed or failing iterator has made, it
    removes. Raises InputError where the material cannot be baked.
    """
    objects = _objects_with(scene, view_layer, material)
    shaders = shaders_of(material.node_tree)
    if not shaders.found:
        raise InputError(f'"{material.name}" has no shader to bake.')
    wanted = [holds for holds in PARTS if shaders.differs(holds)] + ["normal"] * shaders.bends_normals
    images: dict[str, bpy.types.Image] = {}
    added: list[bpy.types.Mesh] = []
    try:
        added = add_maps(objects, material)
        for number, holds in enumerate(wanted):
            yield Step(number, len(wanted), holds)
            images[holds] = _new_image(material, holds, resolution)
            _bake(scene, objects, material, holds, images[holds], samples)
        _finish(material, shaders, images)
    except BaseException:
        for image in images.values():
            bpy.data.images.remove(image)
        remove_maps(added)
        raise


def _objects_with(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer, material: bpy.types.Material) -> list[Any]:
    """One for each mesh that has the material and is rendered."""
    if not material.is_editable:
        raise InputError(f'"{material.name}" is linked: make a library override to bake it.')
    found: dict[Any, Any] = {}
    item: Any
    for item in scene.objects:
        is_there = view_layer.objects.get(item.name) == item and not item.hide_render
        if item.type != "MESH" or not is_there or not len(item.data.polygons):
            continue
        if any(slot.material == material for slot in item.material_slots):
            if not item.data.is_editable:
                raise InputError(f'The mesh of "{item.name}" is linked: make it local to bake on it.')
            if item.mode != "OBJECT":
                raise InputError(f'Leave the mode in which "{item.name}" is edited.')
            found.setdefault(item.data, item)
    if not found:
        raise InputError(f'No mesh that is rendered has the material "{material.name}".')
    return list(found.values())


def _new_image(material: bpy.types.Material, holds: str, resolution: int) -> bpy.types.Image:
    is_float = holds in ("emission", "normal")
    image = bpy.data.images.new(
        f"{material.name} look {holds}", resolution, resolution, alpha=False, float_buffer=is_float
    )
    if holds != "base_color":
        image.colorspace_settings.name = NON_COLOR
    return image


def _bake(
    scene: bpy.types.Scene,
    objects: Sequence[bpy.types.Object],
    material: bpy.types.Material,
    holds: str,
    image: bpy.types.Image,
    samples: int,
) -> None:
    """All objects into one image. (Emitted colors are scene-linear.)"""
    unused = bpy.data.images.new("Curvrefl unused", 4, 4)
    shining = Shining(material, image, holds)
    other = Shining(material, unused, "normal")
    samples = samples if shining.is_noisy else min(samples, LEAST_SAMPLES)
    try:
        with _own_scene(scene, samples) as own, _worn(objects, material, shining.material, other.material):
            view_layer = own.view_layers[0]
            for item in own.objects:
                if view_layer.objects.get(item.name) == item:
                    item.select_set(item in objects, view_layer=view_layer)
            view_layer.objects.active = objects[0]
            with bpy.context.temp_override(
                scene=own,
                view_layer=view_layer,
                active_object=objects[0],
                object=objects[0],
                selected_objects=list(objects),
                selected_editable_objects=list(objects),
            ):
                bpy.ops.object.bake(
                    type="NORMAL" if holds == "normal" else "EMIT",
                    normal_space="TANGENT",
                    margin=MARGIN,
                    use_clear=True,
                    use_selected_to_active=False,
                    save_mode="INTERNAL",
                    target="IMAGE_TEXTURES",
                    uv_layer=UV_MAP,
                )
    except RuntimeError as error:
        raise InputError(f'"{material.name}" was not baked: {error}'.strip()) from error
    finally:
        shining.remove()
        other.remove()
        bpy.data.images.remove(unused)


@contextmanager
def _own_scene(scene: bpy.types.Scene, samples: int) -> Iterator[bpy.types.Scene]:
    """The same objects with Cycles' settings, and a selection of its own."""
    own: Any = scene.copy()
    try:
        own.render.engine = "CYCLES"
        own.cycles.samples, own.cycles.use_adaptive_sampling, own.cycles.use_denoising = samples, False, False
        own.render.use_simplify = scene.render.use_simplify
        yield own
    finally:
        bpy.data.scenes.remove(own)


@contextmanager
def _worn(
    objects: Sequence[bpy.types.Object],
    material: bpy.types.Material,
    shining: Any,
    other: Any,
) -> Iterator[None]:
    """While these objects have other materials."""
    before = [(slot, slot.material) for item in objects for slot in item.material_slots]
    try:
        for slot, worn in before:
            slot.material = shining if worn == material else other
        yield
    finally:
        for slot, worn in before:
            slot.material = worn


def _finish(material: Any, shaders: Shaders, images: dict[str, bpy.types.Image]) -> None:
    """Keep the images in the file, and let a material of them stand for this one."""
    if shaders.single is None and "base_color" in images:
        _divide_by_alpha(shaders, images)
    forget_look(material)
    for image in images.values():
        image.pack()
    made = stand_in(material, shaders, images)
    material[KEY] = {"material": made, "signature": signature(material.node_tree), "images": dict(images)}
    material.update_tag()


def forget_look(material: Any) -> None:
    """Remove what an earlier bake has made."""
    if (old := look_of(material)) is not None:
        bpy.data.materials.remove(old.material)
        for image in old.images.values():
            bpy.data.images.remove(image)
    if KEY in material:
        del material[KEY]


def _divide_by_alpha(shaders: Shaders, images: dict[str, Any]) -> None:
    """Mixed shaders were weighted by what is there."""
    if "surface" not in images or shaders.constant("alpha") is not None:
        return
    alpha = _pixels(images["surface"])[:, 2:3]
    for holds, channels in (("surface", 2), ("base_color", 3), ("layers", 3)):
        if holds in images and (alpha < 1.0).any():
            pixels = _pixels(images[holds])
            is_color = holds == "base_color"
            values = _linear(pixels[:, :channels]) if is_color else pixels[:, :channels]
            values = np.clip(values / np.maximum(alpha, 1e-3), 0.0, 1.0)
            pixels[:, :channels] = _encoded(values) if is_color else values
            images[holds].pixels.foreach_set(pixels.ravel())


def _pixels(image: Any) -> np.ndarray:
    """(n, 4)"""
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(-1, 4)


def _linear(encoded: np.ndarray) -> np.ndarray:
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def _encoded(linear: np.ndarray) -> np.ndarray:
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * np.maximum(linear, 1e-9) ** (1.0 / 2.4) - 0.055)
