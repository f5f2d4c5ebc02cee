# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What of a scene is written down for others: a description in JSON, meshes as PLY, and the sums of all files."""

from __future__ import annotations

import hashlib
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from ...scene.arrays import LightArrays, MaterialArrays, MeshArrays, SceneArrays
from ...scene.camera.view import View

VERSION = 1
"""Another one where any reference differs"""
CONVENTIONS = {
    "lengths": "meters",
    "angles": "radians",
    "space": "right-handed, Z up",
    "matrices": "rows first, to be multiplied with columns: world = object_to_world * (x, y, z, 1)",
    "camera": "looks along -Z of its own space, Y up",
    "projection": "OpenGL clip space: x, y and z from -1 to 1, Y up",
    "pixels": "references are of the pixels' centers: x to the right, y up, both from 0.5; OpenEXR files have the top "
    "row first",
    "colors": "scene-linear Rec.709",
    "meshes": "object space; corners with the shading normals that are interpolated and then made unit length; faces "
    "counter-clockwise as seen from the side that normals point to, clockwise where `mirrored`",
    "mirror law": "about the interpolated shading normal; a mirror seen in a mirror counts as the point that is hit",
}


def description(
    name: str, text: str, scene: SceneArrays, view: View, mirrors: dict[str, dict[str, Any]], rendered: dict[str, Any]
) -> dict[str, Any]:
    """Of a scene, but for its meshes, which are in files of their own; `mirrors`: by name what formula they have."""
    return {
        "dataset": "curvrefl",
        "version": VERSION,
        "scene": name,
        "text": text,
        "conventions": CONVENTIONS,
        "camera": {
            "width": view.width,
            "height": view.height,
            "world_to_camera": view.world_to_view.tolist(),
            "projection": view.view_to_clip.tolist(),
            "eye": view.place.tolist(),
        },
        "mirrors": [
            {"name": title, "object": number, "surface": mirrors[title] or None}
            for title, number in sorted(_mirror_ids(scene).items(), key=lambda item: item[1])
        ],
        "objects": [
            {
                "name": instance.object_name,
                "id": instance.object_id,
                "mesh": mesh_file(instance.mesh),
                "object_to_world": instance.matrix.tolist(),
                "mirrored": bool(np.linalg.det(instance.matrix[:3, :3]) < 0.0),
                "materials": [scene.materials[index].name for index in instance.materials],
            }
            for instance in scene.instances
        ],
        "materials": [_material(item) for item in scene.materials],
        "lamps": [_lamp(item) for item in scene.lights],
        "world": {
            "color": list(scene.world.color),
            "constant": scene.world.emitter is None and scene.world.image is None,
        },
        "cycles": rendered,
    }


def mesh_file(number: int) -> str:
    """Of a mesh of a scene."""
    return f"mesh_{number:03d}.ply"


def write_ply(path: Path, mesh: MeshArrays) -> None:
    """Corners with positions, shading normals and texture coordinates where there are some, and triangles; binary."""
    names = ["x", "y", "z", "nx", "ny", "nz"] + (["s", "t"] if mesh.corner_uv is not None else [])
    columns = [mesh.positions[mesh.corner_vertex], mesh.corner_normals]
    columns += [mesh.corner_uv] if mesh.corner_uv is not None else []
    corners = np.ascontiguousarray(np.concatenate(columns, axis=1), "<f4")
    faces = np.zeros(len(mesh.triangles), np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    faces["count"], faces["corners"] = 3, mesh.triangles
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(corners)}"]
    head += [f"property float {name}" for name in names]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    path.write_bytes("\n".join(head).encode() + corners.tobytes() + faces.tobytes())


def read_ply(path: Path) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """What `write_ply` has written: numbers of corners (n,) by name, triangles (m, 3)."""
    head, _, data = path.read_bytes().partition(b"end_header\n")
    lines = [line.split() for line in head.decode().splitlines()]
    vertices, faces = (int(line[2]) for line in lines if line[0] == "element")
    names = [line[2] for line in lines if line[:2] == ["property", "float"]]
    corners = np.frombuffer(data, "<f4", vertices * len(names)).reshape(vertices, len(names))
    kind = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
    triangles = np.frombuffer(data, kind, faces, offset=corners.nbytes)["corners"]
    return {name: corners[:, number] for number, name in enumerate(names)}, triangles


def sums_of(folder: Path) -> dict[str, str]:
    """SHA-256 of all files of a folder but its report, by name."""
    return {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.iterdir())
        if path.is_file() and path.name != REPORT
    }


REPORT = "report.json"
"""Of one scene: how it was made, and the sums of its files. It comes last"""


def whole_report(folder: Path) -> dict[str, Any] | None:
    """The scene's report, where all that it names is there as it was written."""
    try:
        report = json.loads((folder / REPORT).read_text(encoding="utf-8"))
        return report if sums_of(folder) == report["sha256"] else None
    except (OSError, ValueError, KeyError, TypeError, struct.error):
        return None


def _mirror_ids(scene: SceneArrays) -> dict[str, int]:
    return {item.object_name: item.object_id for item in scene.instances if item.object_id in scene.reflectors}


def _material(item: MaterialArrays) -> dict[str, Any]:
    return {
        "name": item.name,
        "base_color": None if item.varies("base_color") else list(item.base_color),
        "metallic": item.metallic,
        "roughness": item.roughness,
        "ior": item.ior,
        "transmission": item.transmission,
        "emission": list(item.emission),
        "varies": item.program is not None,
    }


def _lamp(item: LightArrays) -> dict[str, Any]:
    return {
        "name": item.name,
        "kind": item.kind,
        "color": list(item.color),
        "lamp_to_world": item.matrix.tolist(),
        "radius": item.radius,
        "angle": item.angle,
        "size": list(item.size),
        "spot_angle": item.spot_angle,
    }
