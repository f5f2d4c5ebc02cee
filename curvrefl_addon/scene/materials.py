# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender materials to the part of the Principled BSDF that the renderer shades."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from .arrays import ImageArrays, MaterialArrays


class MaterialReader:
    """Collects materials, their images, and what could not be read."""

    def __init__(self) -> None:
        self.materials: list[MaterialArrays] = [MaterialArrays("default")]
        self.images: list[ImageArrays] = []
        self.warnings: list[str] = []
        self._known: dict[int, int] = {}
        self._known_images: dict[tuple[int, bool, bool], int] = {}

    def index_of(self, material: bpy.types.Material | None) -> int:
        """Index into `materials`; 0 for an empty slot."""
        if material is None:
            return 0
        key = material.original.session_uid
        if key not in self._known:
            self._known[key] = len(self.materials)
            self.materials.append(self._read(material))
        return self._known[key]

    def _warn(self, material: bpy.types.Material, what: str) -> None:
        self.warnings.append(f'Material "{material.name}": {what}.')

    def _read(self, material: bpy.types.Material) -> MaterialArrays:
        viewport = tuple(material.diffuse_color)[:3]
        fallback = MaterialArrays(
            material.name, base_color=viewport, metallic=material.metallic, roughness=material.roughness
        )
        output = material.node_tree.get_output_node("CYCLES") if material.node_tree else None
        if output is None:
            return fallback
        shader = _source(output.inputs["Surface"])
        while shader is not None and shader.type in ("MIX_SHADER", "ADD_SHADER"):
            self._warn(material, "mixed shaders are not followed, the first one is taken")
            inputs = [socket for socket in shader.inputs if socket.type == "SHADER"]
            shader = next((node for node in map(_source, inputs) if node is not None), None)
        if shader is None:
            return replace(fallback, base_color=(0.0, 0.0, 0.0), specular_level=0.0)
        if shader.type == "BSDF_PRINCIPLED":
            return self._principled(material, shader)
        if shader.type == "BSDF_DIFFUSE":
            base = MaterialArrays(material.name, roughness=1.0, specular_level=0.0)
            return self._with_color(material, base, shader.inputs["Color"])
        if shader.type in ("BSDF_GLOSSY", "BSDF_METALLIC"):
            base = MaterialArrays(
                material.name, roughness=self._number(material, shader, "Roughness"), glossy_only=True
            )
            color = shader.inputs["Color"] if "Color" in shader.inputs else shader.inputs["Base Color"]
            return self._with_color(material, base, color)
        if shader.type == "EMISSION":
            strength = self._number(material, shader, "Strength")
            color = self._constant(material, shader, "Color")
            emission = tuple(strength * channel for channel in color)
            return MaterialArrays(material.name, base_color=(0, 0, 0), specular_level=0.0, emission=emission)
        self._warn(material, f"the shader {shader.bl_label} is not supported, its viewport colour is used")
        return fallback

    def _principled(self, material: bpy.types.Material, shader: bpy.types.Node) -> MaterialArrays:
        strength = self._number(material, shader, "Emission Strength")
        color = self._constant(material, shader, "Emission Color") if strength else (0.0, 0.0, 0.0)
        for name in ("Transmission Weight", "Coat Weight", "Subsurface Weight", "Sheen Weight"):
            if shader.inputs[name].is_linked or shader.inputs[name].default_value > 0.0:
                self._warn(material, f"{name} is not supported and left out")
        if shader.inputs["Normal"].is_linked:
            self._warn(material, "bump and normal maps are not supported and left out")
        base = MaterialArrays(
            material.name,
            metallic=self._number(material, shader, "Metallic"),
            roughness=self._number(material, shader, "Roughness"),
            ior=self._number(material, shader, "IOR"),
            specular_level=self._number(material, shader, "Specular IOR Level"),
            emission=tuple(strength * channel for channel in color),
        )
        return self._with_color(material, base, shader.inputs["Base Color"])

    def _number(self, material: bpy.types.Material, node: bpy.types.Node, name: str) -> float:
        socket = node.inputs[name]
        source = _source(socket)
        if source is not None:
            if source.type == "VALUE":
                return float(source.outputs[0].default_value)
            self._warn(material, f"the texture on {name} is not supported, its slider's value is used")
        return float(socket.default_value)

    def _constant(self, material: bpy.types.Material, node: bpy.types.Node, name: str) -> tuple[float, float, float]:
        socket = node.inputs[name]
        source = _source(socket)
        if source is not None:
            if source.type == "RGB":
                return tuple(source.outputs[0].default_value)[:3]
            self._warn(material, f"the texture on {name} is not supported, its plain colour is used")
        return tuple(socket.default_value)[:3]

    def _with_color(
        self, material: bpy.types.Material, base: MaterialArrays, socket: bpy.types.NodeSocket
    ) -> MaterialArrays:
        """`base` with its base colour from `socket`: a value, an image, vertex colours, or a product of those."""
        node = _source(socket)
        if node is None:
            return replace(base, base_color=tuple(socket.default_value)[:3])
        if node.type == "RGB":
            return replace(base, base_color=tuple(node.outputs[0].default_value)[:3])
        if node.type == "TEX_IMAGE" and node.image is not None:
            return self._textured(material, replace(base, base_color=(1.0, 1.0, 1.0)), node)
        if node.type == "VERTEX_COLOR" or (node.type == "ATTRIBUTE" and node.attribute_type == "GEOMETRY"):
            return replace(base, base_color=(1.0, 1.0, 1.0), uses_vertex_color=True)
        if node.type == "MIX" and node.data_type == "RGBA" and node.blend_type == "MULTIPLY":
            factor = next(s for s in node.inputs if s.identifier == "Factor_Float")
            if not factor.is_linked and factor.default_value == 1.0:
                first, second = (next(s for s in node.inputs if s.identifier == f"{k}_Color") for k in "AB")
                a = self._with_color(material, base, first)
                b = self._with_color(material, base, second)
                if a.image < 0 or b.image < 0:
                    mapped = a if a.image >= 0 else b
                    product = tuple(p * q for p, q in zip(a.base_color, b.base_color, strict=True))
                    return replace(
                        mapped, base_color=product, uses_vertex_color=a.uses_vertex_color or b.uses_vertex_color
                    )
        self._warn(material, f"the node {node.bl_label} on the base colour is not supported, a plain colour is used")
        return replace(base, base_color=_middle_color(node, socket))

    def _textured(
        self, material: bpy.types.Material, base: MaterialArrays, node: bpy.types.Node
    ) -> MaterialArrays:
        scale, offset = np.ones(2), np.zeros(2)
        vector = _source(node.inputs["Vector"])
        if vector is not None and vector.type == "MAPPING":
            inputs = vector.inputs
            simple = vector.vector_type == "POINT" and not any(
                inputs[name].is_linked for name in ("Location", "Rotation", "Scale")
            )
            if simple and not any(inputs["Rotation"].default_value):
                scale = np.array(inputs["Scale"].default_value)[:2]
                offset = np.array(inputs["Location"].default_value)[:2]
            else:
                self._warn(material, "a texture mapping that turns or is driven is not supported and left out")
            vector = _source(inputs["Vector"])
        by_uv = vector is None or vector.type == "UVMAP" or _output_name(node, "Vector") in ("UV", "")
        if not by_uv:
            self._warn(material, "texture coordinates other than UV are not supported, UV is used")
        if node.projection != "FLAT":
            self._warn(material, "image projections other than flat are not supported, UV is used")
        pixels = self._image(material, node)
        if pixels < 0:
            return base
        return replace(
            base,
            image=pixels,
            uv_scale=(float(scale[0]), float(scale[1])),
            uv_offset=(float(offset[0]), float(offset[1])),
        )

    def _image(self, material: bpy.types.Material, node: bpy.types.Node) -> int:
        image = node.image
        repeat, nearest = node.extension == "REPEAT", node.interpolation == "Closest"
        key = (image.original.session_uid, repeat, nearest)
        if key not in self._known_images:
            pixels = read_image(image)
            if pixels is None:
                self._warn(material, f'the image "{image.name}" has no pixels, is its file missing?')
                self._known_images[key] = -1
            else:
                self._known_images[key] = len(self.images)
                self.images.append(ImageArrays(image.name, pixels, repeat, nearest))
        return self._known_images[key]


def read_image(image: bpy.types.Image) -> np.ndarray | None:
    """(height, width, 4) scene-linear float32 of an image, row 0 at the bottom; None without pixels."""
    width, height = image.size
    if width == 0 or height == 0 or len(image.pixels) == 0:
        return None
    values = np.empty((height, width, image.channels), np.float32)
    image.pixels.foreach_get(values.ravel())
    pixels = np.ones((height, width, 4), np.float32)
    if image.channels == 1:
        pixels[..., :3] = values
    else:
        pixels[..., : image.channels] = values
    # Float images come scene-linear, byte images as they are stored.
    if not image.is_float and image.colorspace_settings.name == "sRGB":
        color = pixels[..., :3]
        pixels[..., :3] = np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)
    return pixels


def _source(socket: bpy.types.NodeSocket) -> bpy.types.Node | None:
    """The node behind a socket, reroutes and muted links passed over."""
    while socket.is_linked:
        link = socket.links[0]
        if link.is_muted:
            return None
        if link.from_node.type != "REROUTE":
            return link.from_node
        socket = link.from_node.inputs[0]
    return None


def _output_name(node: bpy.types.Node, name: str) -> str:
    links = node.inputs[name].links
    if links and links[0].from_node.type == "MAPPING":
        return _output_name(links[0].from_node, "Vector")
    return links[0].from_socket.name if links else ""


def _middle_color(node: bpy.types.Node, socket: bpy.types.NodeSocket) -> tuple[float, float, float]:
    """Mean of the colours that a node mixes, for lack of better."""
    colors = [
        tuple(s.default_value)[:3] for s in node.inputs if s.type == "RGBA" and not s.is_linked and s.enabled
    ] or [tuple(socket.default_value)[:3]]
    mean = np.mean(np.array(colors, float), axis=0)
    return (float(mean[0]), float(mean[1]), float(mean[2]))
