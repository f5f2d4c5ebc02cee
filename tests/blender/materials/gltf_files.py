# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""glTF files with one square for each of many materials, and all that the importer can make of a material."""

from __future__ import annotations

import base64
import io
import json
import struct
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import addon_utils
import bpy
import numpy as np

TRANSFORM = {"KHR_texture_transform": {"offset": [0.25, 0.5], "scale": [2.0, 3.0]}}
TURN = {"KHR_texture_transform": {"offset": [0.1, 0.2], "scale": [1.5, 0.75], "rotation": 0.4, "texCoord": 1}}
SHADES, NORMALS, ALPHA, GRAYS = range(4)
"""Images: any colors, normals in tangent space, colors with any alpha, gentle grays"""


def images() -> list[np.ndarray]:
    """(8, 8, 4) bytes each."""
    random = np.random.default_rng(3)
    shades = random.integers(40, 216, (8, 8, 4), np.uint8)
    shades[..., 3] = 255
    normals = np.full((8, 8, 4), 255, np.uint8)
    normals[..., :2] = random.integers(96, 160, (8, 8, 2))
    normals[..., 2] = 235
    alpha = random.integers(20, 235, (8, 8, 4), np.uint8)
    grays = np.full((8, 8, 4), 255, np.uint8)
    grays[..., :3] = random.integers(60, 200, (8, 8, 3))
    return [shades, normals, alpha, grays]


def _texture(index: int, **more: Any) -> dict[str, Any]:
    return {"index": index, **more}


def _pbr(**more: Any) -> dict[str, Any]:
    return {"pbrMetallicRoughness": {"baseColorTexture": _texture(SHADES), "metallicFactor": 0.0, **more}}


def _extension(name: str, pbr: Mapping[str, Any] = {}, **values: Any) -> dict[str, Any]:
    return {**_pbr(roughnessFactor=0.4, **pbr), "extensions": {f"KHR_materials_{name}": values}}


MATERIALS: dict[str, dict[str, Any]] = {
    "factors": {
        "pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.3, 0.2, 1.0], "metallicFactor": 0.2, "roughnessFactor": 0.6}
    },
    "metallic and roughness": _pbr(
        metallicFactor=0.8,
        roughnessFactor=0.9,
        metallicRoughnessTexture=_texture(GRAYS),
        baseColorFactor=[1.0, 0.8, 0.6, 1.0],
    ),
    "normals": {**_pbr(roughnessFactor=0.5), "normalTexture": _texture(NORMALS, scale=0.7)},
    "occlusion": {
        **_pbr(metallicFactor=1.0, metallicRoughnessTexture=_texture(GRAYS)),
        "occlusionTexture": _texture(GRAYS, strength=0.5),
    },
    "emission": {
        **_pbr(),
        "emissiveTexture": _texture(GRAYS),
        "emissiveFactor": [0.9, 0.5, 0.1],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 1.5}},
    },
    "mask": {"alphaMode": "MASK", "alphaCutoff": 0.4, **_pbr(baseColorTexture=_texture(ALPHA))},
    "mask by the default": {"alphaMode": "MASK", **_pbr(baseColorTexture=_texture(ALPHA))},
    "blend": {
        "alphaMode": "BLEND",
        **_pbr(baseColorTexture=_texture(ALPHA), baseColorFactor=[1.0, 1.0, 1.0, 0.75]),
    },
    "opaque": {"alphaMode": "OPAQUE", **_pbr(baseColorTexture=_texture(ALPHA))},
    "texture transform": _pbr(baseColorTexture=_texture(SHADES, extensions=TRANSFORM)),
    "turned, of another map": _pbr(
        baseColorTexture=_texture(SHADES, extensions=TURN),
        metallicFactor=1.0,
        metallicRoughnessTexture=_texture(GRAYS, extensions=TURN),
    ),
    "clear coat": _extension(
        "clearcoat",
        clearcoatFactor=0.8,
        clearcoatTexture=_texture(GRAYS),
        clearcoatRoughnessFactor=0.5,
        clearcoatRoughnessTexture=_texture(GRAYS),
    ),
    "bumpy coat": _extension("clearcoat", clearcoatFactor=0.8, clearcoatNormalTexture=_texture(NORMALS)),
    "transmission": _extension("transmission", transmissionFactor=0.75, transmissionTexture=_texture(GRAYS)),
    "sheen": _extension(
        "sheen",
        sheenColorFactor=[0.8, 0.6, 0.4],
        sheenColorTexture=_texture(SHADES),
        sheenRoughnessFactor=0.6,
        sheenRoughnessTexture=_texture(ALPHA),
    ),
    "specular": _extension(
        "specular",
        specularFactor=0.8,
        specularTexture=_texture(ALPHA),
        specularColorFactor=[1.0, 0.5, 0.25],
        specularColorTexture=_texture(SHADES),
    ),
    "index of refraction": _extension("ior", ior=1.25),
    "volume": {
        **_pbr(roughnessFactor=0.0),
        "extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 1.0},
            "KHR_materials_volume": {
                "thicknessFactor": 1.0,
                "attenuationDistance": 2.0,
                "attenuationColor": [0.5, 0.25, 1.0],
            },
        },
    },
    "anisotropy": {
        **_pbr(metallicFactor=1.0, roughnessFactor=0.5),
        "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.6, "anisotropyRotation": 0.5}},
    },
    "unlit": {**_pbr(), "extensions": {"KHR_materials_unlit": {}}},
}
"""By what each has"""
PAINTED = ("factors", "metallic and roughness")
"""Those on squares with vertex colors"""


def png(pixels: np.ndarray) -> bytes:
    """Of (h, w, 4) bytes."""
    height, width = pixels.shape[:2]
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def import_gltf(path: Path) -> None:
    """Into the open scene."""
    addon_utils.enable("io_scene_gltf2", default_set=False)
    bpy.ops.import_scene.gltf(filepath=str(path))


def export_gltf(path: Path) -> None:
    """The open scene."""
    addon_utils.enable("io_scene_gltf2", default_set=False)
    bpy.ops.export_scene.gltf(filepath=str(path), export_format="GLB", export_vertex_color="ACTIVE")


def write_gltf(
    path: Path, materials: Mapping[str, dict[str, Any]], columns: int = 5, painted: tuple[str, ...] = ()
) -> None:
    """A square of 0.9 m for each material, named by it, a meter apart in the plane that faces Blender's -Y."""
    data = io.BytesIO()
    views: list[dict[str, Any]] = []
    accessors: list[dict[str, Any]] = []

    def accessor(values: np.ndarray, kind: str) -> int:
        views.append({"buffer": 0, "byteOffset": data.tell(), "byteLength": values.nbytes})
        data.write(values.tobytes())
        component = 5126 if values.dtype == np.float32 else 5123
        extent = {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()} if kind == "VEC3" else {}
        count = len(values)
        accessors.append(
            {"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind, **extent}
        )
        return len(accessors) - 1

    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)
    other = corners @ np.array([[0.9, 0.2], [-0.3, 0.8]], np.float32) + np.float32(0.1)
    places = np.column_stack([0.9 * corners - 0.45, np.zeros(4)]).astype(np.float32)
    attributes = {
        "POSITION": accessor(places, "VEC3"),
        "NORMAL": accessor(np.tile(np.array([0, 0, 1], np.float32), (4, 1)), "VEC3"),
        "TEXCOORD_0": accessor(corners, "VEC2"),
        "TEXCOORD_1": accessor(other.astype(np.float32), "VEC2"),
    }
    colors = np.column_stack([0.3 + 0.6 * corners[:, 0], 0.9 - 0.5 * corners[:, 1], corners.mean(1), np.ones(4)])
    color = accessor(colors.astype(np.float32), "VEC4")
    indices = accessor(np.array([0, 1, 2, 0, 2, 3], np.uint16), "SCALAR")
    meshes, nodes = [], []
    for number, name in enumerate(materials):
        own = {**attributes, "COLOR_0": color} if name in painted else attributes
        meshes.append({"name": name, "primitives": [{"attributes": own, "indices": indices, "material": number}]})
        nodes.append({"mesh": number, "name": name, "translation": [number % columns, number // columns, 0.0]})
    used = {extension for material in materials.values() for extension in material.get("extensions", {})}
    uri = "data:{};base64,{}"
    file = {
        "asset": {"version": "2.0"},
        "extensionsUsed": sorted({"KHR_texture_transform", *used}),
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": [{"name": name, **material} for name, material in materials.items()],
        "textures": [{"source": number} for number in range(len(images()))],
        "images": [{"uri": uri.format("image/png", base64.b64encode(png(pixels)).decode())} for pixels in images()],
        "buffers": [
            {
                "byteLength": data.tell(),
                "uri": uri.format("application/octet-stream", base64.b64encode(data.getvalue()).decode()),
            }
        ],
        "bufferViews": views,
        "accessors": accessors,
    }
    path.write_text(json.dumps(file))
