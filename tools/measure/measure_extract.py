# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How long the extraction of one mesh of a million vertices takes, and how much memory it adds.

    .venv/bin/python tools/measure/measure_extract.py [--side 1000] [--repeats 5]

Each kind of mesh is read by a process of its own. Before every repeat the mesh is tagged as changed, so Blender
evaluates it again (not timed) and its normals and triangles are computed anew (timed).
"""

from __future__ import annotations

import argparse
import resource
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import bpy
import numpy as np

KINDS = ("smooth", "smooth with UV", "flat", "sharp edges with UV")


def grid(side: int, kind: str) -> bpy.types.Object:
    """A wavy square of `side` x `side` vertices, in quads, with a textured material where `kind` has a UV map."""
    steps = np.linspace(-1.0, 1.0, side, dtype=np.float32)
    x, y = np.meshgrid(steps, steps)
    positions = np.stack([x, y, 0.1 * np.sin(5.0 * x) * np.cos(4.0 * y)], axis=-1).astype(np.float32)
    index = np.arange(side * side, dtype=np.int32).reshape(side, side)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1).reshape(-1, 4)
    mesh = bpy.data.meshes.new("grid")
    mesh.vertices.add(side * side)
    mesh.vertices.foreach_set("co", positions.reshape(-1))
    mesh.loops.add(quads.size)
    mesh.loops.foreach_set("vertex_index", quads.reshape(-1))
    mesh.polygons.add(len(quads))
    mesh.polygons.foreach_set("loop_start", np.arange(0, quads.size, 4, dtype=np.int32))
    mesh.update(calc_edges=True)
    if kind == "flat":
        mesh.shade_flat()
    else:
        mesh.shade_smooth()
    if kind.startswith("sharp"):
        sharp = np.zeros(len(mesh.edges), bool)
        sharp[::101] = True
        attribute: Any = mesh.attributes.new("sharp_edge", "BOOLEAN", "EDGE")
        attribute.data.foreach_set("value", sharp)
    if kind.endswith("UV"):
        uv = (0.5 * positions[..., :2] + 0.5).reshape(-1, 2)[quads.reshape(-1)]
        mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", np.ascontiguousarray(uv).reshape(-1))
        material = bpy.data.materials.new("textured")
        tree = material.node_tree
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = bpy.data.images.new("texture", 8, 8)
        tree.links.new(texture.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
        mesh.materials.append(material)
    obj = bpy.data.objects.new("grid", mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def measure(side: int, repeats: int, kind: str) -> None:
    """Print one line for meshes of `kind`."""
    bootstrap.load_package()
    from curvrefl.curvrefl_addon.scene.extract import extract_scene

    bpy.ops.wm.read_factory_settings(use_empty=True)
    obj = grid(side, kind)
    scene = bpy.context.scene
    assert scene is not None
    times, cpu_times = [], []
    corners = 0
    bpy.context.evaluated_depsgraph_get()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(repeats):
        obj.data.update_tag()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        depsgraph.update()
        cpu_start, start = time.process_time(), time.perf_counter()
        arrays = extract_scene(depsgraph, scene, [obj])
        times.append(time.perf_counter() - start)
        cpu_times.append(time.process_time() - cpu_start)
        corners = len(arrays.meshes[0].corner_vertex)
    added = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024.0
    print(
        f"{kind:22s} {len(obj.data.vertices):8d} vertices {corners:8d} corners   "
        f"median {statistics.median(times):.3f} s   fastest {min(times):.3f} s   "
        f"processors {statistics.median(cpu_times):.3f} s   peak memory +{added:.0f} MiB",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--side", type=int, default=1000, help="vertices along a side")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--kind", choices=KINDS, help="only this one, in this process")
    options = parser.parse_args()
    if options.kind:
        measure(options.side, options.repeats, options.kind)
        return
    for kind in KINDS:
        arguments = ["--side", str(options.side), "--repeats", str(options.repeats), "--kind", kind]
        subprocess.run([sys.executable, __file__, *arguments], check=True)


if __name__ == "__main__":
    main()
