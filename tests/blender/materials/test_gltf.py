# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of glTF files, as Blender's importer builds them."""

from __future__ import annotations

import base64
import io
import json
import struct
import zlib
from pathlib import Path
from typing import Any

import addon_utils
import bpy
import numpy as np
import pytest
from channels import channel_on
from curvrefl.curvrefl_addon.scene.arrays import Glass, MaterialArrays, SceneArrays
from extraction import empty_scene, extracted

TRANSFORM = {"KHR_texture_transform": {"offset": [0.25, 0.5], "scale": [2.0, 3.0]}}
TEXEL = np.random.default_rng(3).integers(40, 216, (8, 8, 4), np.uint8)


def png(pixels: Any) -> bytes:
    """Of (h, w, 4) bytes."""
    height, width = pixels.shape[:2]
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def imported(folder: Path, material: dict[str, Any]) -> SceneArrays:
    """A square of the material, with one image, as the importer reads it from a file."""
    positions = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], np.float32)
    uv = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)
    triangles = np.array([0, 1, 2, 0, 2, 3], np.uint16)
    data = io.BytesIO()
    views = []
    for part in (positions.tobytes(), uv.tobytes(), triangles.tobytes()):
        views.append({"buffer": 0, "byteOffset": data.tell(), "byteLength": len(part)})
        data.write(part)
    accessor: dict[str, Any] = {"componentType": 5126, "count": 4}
    file = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_texture_transform", *material.get("extensions", {})],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "part"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"name": "made", **material}],
        "textures": [{"source": 0}],
        "images": [{"uri": "data:image/png;base64," + base64.b64encode(png(TEXEL)).decode()}],
        "buffers": [
            {
                "byteLength": len(data.getvalue()),
                "uri": "data:application/octet-stream;base64," + base64.b64encode(data.getvalue()).decode(),
            }
        ],
        "bufferViews": views,
        "accessors": [
            {**accessor, "bufferView": 0, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {**accessor, "bufferView": 1, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
    }
    path = folder / "made.gltf"
    path.write_text(json.dumps(file))
    empty_scene()
    addon_utils.enable("io_scene_gltf2", default_set=False)
    bpy.ops.import_scene.gltf(filepath=str(path))
    return extracted(next(obj for obj in bpy.context.scene.objects if obj.type == "MESH"))


def made(scene: SceneArrays) -> MaterialArrays:
    return next(material for material in scene.materials if material.name == "made")


TEXTURE = {"index": 0, "extensions": TRANSFORM}


CHANNELS = ("base_color", "roughness", "metallic", "alpha")


@pytest.mark.usefixtures("gpu")
@pytest.mark.parametrize("mode", ["MASK", "BLEND", "OPAQUE"])
def test_roughness_metallic_and_alpha_of_images(tmp_path: Path, mode: str) -> None:
    cutoff = {"alphaCutoff": 0.4} if mode == "MASK" else {}
    pbr = {"baseColorTexture": TEXTURE, "metallicRoughnessTexture": TEXTURE, "baseColorFactor": [1, 1, 1, 0.75]}
    scene = imported(tmp_path, {"alphaMode": mode, **cutoff, "pbrMetallicRoughness": pbr})
    material = made(scene)
    # In the middles of its pixels, rows from above.
    v, u = (np.mgrid[0:8, 0:8] + 0.5).reshape(2, -1) / 8.0
    values = TEXEL[(v * 8).astype(int), (u * 8).astype(int)] / 255.0
    places = np.column_stack([(u - 0.25) / 2.0, (v - 0.5) / 3.0])
    found = {name: channel_on(scene, "part", name, places) for name in CHANNELS}
    np.testing.assert_allclose(found["roughness"][:, 0], values[:, 1], atol=1e-5)
    np.testing.assert_allclose(found["metallic"][:, 0], values[:, 2], atol=1e-5)
    expected = {"OPAQUE": np.ones(64), "BLEND": values[:, 3] * 0.75, "MASK": values[:, 3] * 0.75 >= 0.4}[mode]
    np.testing.assert_allclose(found["alpha"][:, 0], expected, atol=1e-5)
    # (One image for all, which the importer takes for no colors then.)
    np.testing.assert_allclose(found["base_color"], values[:, :3], atol=1e-5)
    assert material.is_seen_through == (mode != "OPAQUE")
    assert not [warning for warning in scene.warnings if "material" in warning]


def test_extensions(tmp_path: Path) -> None:
    extensions = {
        "KHR_materials_transmission": {"transmissionFactor": 0.75},
        "KHR_materials_ior": {"ior": 1.25},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25},
        "KHR_materials_specular": {"specularColorFactor": [1.0, 0.5, 0.25]},
        "KHR_materials_volume": {
            "thicknessFactor": 1.0,
            "attenuationDistance": 2.0,
            "attenuationColor": [0.5, 0.25, 1.0],
        },
    }
    pbr = {"metallicFactor": 0.0, "roughnessFactor": 0.125}
    scene = imported(tmp_path, {"pbrMetallicRoughness": pbr, "extensions": extensions})
    material = made(scene)
    assert (material.transmission, material.glass, material.ior) == (0.75, Glass.PRINCIPLED, 1.25)
    assert (material.coat_weight, material.coat_roughness, material.roughness) == (0.5, 0.25, 0.125)
    np.testing.assert_allclose(material.specular_tint, (1.0, 0.5, 0.25), rtol=1e-5)
    # (As the importer's Volume Absorption node has it.)
    np.testing.assert_allclose(material.absorption, (1.0 - np.array((0.5, 0.25, 1.0))) / 2.0, rtol=1e-5)
    assert not [warning for warning in scene.warnings if "material" in warning]
