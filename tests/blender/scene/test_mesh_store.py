# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that meshes get as they come and go, and which of their arrays stay while they deform."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.geometry.vertex_uploads import is_deformed
from curvrefl.curvrefl_addon.scene.arrays import Float32Array, MeshArrays, SceneArrays
from curvrefl.curvrefl_addon.scene.changes import Changes
from curvrefl.curvrefl_addon.scene.extract import SceneReader, extract_scene
from curvrefl.curvrefl_addon.scene.meshes import meshes
from curvrefl.curvrefl_addon.scene.meshes.mesh_store import MeshStore
from curvrefl.curvrefl_addon.scene.meshes.meshes import MeshNeeds
from curvrefl.curvrefl_addon.scene.meshes.topology import Source, Topology
from extraction import add_mesh, empty_scene


class Unsearchable(list[MeshArrays]):
    """May be read at a place, not searched."""

    def __iter__(self) -> Any:
        raise AssertionError("searched")

    def __contains__(self, _item: object) -> bool:
        raise AssertionError("searched")


def test_a_free_number_for_a_mesh_is_not_searched_for() -> None:
    """The lowest that is free, so that there are no more numbers than meshes were ever there at once."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    objects = [add_mesh(f"Mesh {index}", 1.0 + index) for index in range(20)]
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = [obj.evaluated_get(depsgraph) for obj in objects]
    store = MeshStore()
    store.meshes = Unsearchable()

    def walk(chosen: list[int]) -> list[int]:
        store.begin()
        numbers = [store.read(evaluated[index], 1 + index, MeshNeeds(), False).number for index in chosen]
        store.end()
        return numbers

    assert walk(list(range(12))) == list(range(12))
    assert walk([0, 1, 4, 5, 8, 9]) == [0, 1, 4, 5, 8, 9]
    assert walk([0, 1, 4, 5, 8, 9, *range(12, 20)]) == [0, 1, 4, 5, 8, 9, 2, 3, 6, 7, 10, 11, 12, 13]
    for number, index in zip([2, 13], [12, 19], strict=True):
        assert store.meshes[number].positions.max() == 1.0 + index


def waving_grid(name: str, **look: bool) -> bpy.types.Object:
    """Under a modifier that moves its vertices from frame to frame."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=12, y_subdivisions=9, size=4.0)
    grid = bpy.context.object
    grid.name = grid.data.name = name
    wave = grid.modifiers.new("Wave", "WAVE")
    wave.height, wave.width, wave.narrowness = 1.0, 1.2, 1.5
    if not look.get("flat"):
        grid.data.shade_smooth()
    if look.get("sharp"):
        for edge in list(grid.data.edges)[::7]:
            edge.use_edge_sharp = True
    if look.get("textured"):
        material = bpy.data.materials.new("textured")
        texture = material.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = bpy.data.images.new("image", 2, 2)
        base = material.node_tree.nodes["Principled BSDF"].inputs["Base Color"]
        material.node_tree.links.new(texture.outputs["Color"], base)
        grid.data.materials.append(material)
    if look.get("mirrored"):
        grid.scale.x = -1.0
    return grid


def read_frame(reader: SceneReader, frame: int) -> MeshArrays:
    scene = bpy.context.scene
    scene.frame_set(frame)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    arrays = reader.read(depsgraph, scene, [], Changes(geometry={obj.session_uid for obj in bpy.data.objects}))
    fresh = extract_scene(depsgraph, scene, [])
    for mesh, expected in zip(used_meshes(arrays), used_meshes(fresh), strict=True):
        for name in ("positions", "corner_normals", "corner_vertex", "triangles", "triangle_slot", "corner_attributes"):
            np.testing.assert_array_equal(getattr(mesh, name), getattr(expected, name))
    return used_meshes(arrays)[0]


def used_meshes(scene: SceneArrays) -> list[MeshArrays]:
    return [scene.meshes[instance.mesh] for instance in scene.instances]


@pytest.mark.parametrize("look", ["smooth", "flat", "sharp", "textured", "mirrored"])
def test_what_deforms_keeps_all_but_its_vertices(look: str) -> None:
    empty_scene()
    grid = waving_grid("grid", **{look: True})
    reader = SceneReader()
    first = read_frame(reader, 20)
    second = read_frame(reader, 21)
    assert np.abs(second.positions - first.positions).max() > 1e-3
    assert is_deformed(first, second)
    assert read_frame(reader, 21) is second, "an edit that changes nothing"
    subdivision = grid.modifiers.new("finer", "SUBSURF")
    subdivision.levels = subdivision.render_levels = 1
    finer = read_frame(reader, 22)
    assert not is_deformed(second, finer) and len(finer.triangles) > len(first.triangles)
    assert is_deformed(finer, read_frame(reader, 23))


def test_a_third_reading_takes_positions_and_normals_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """How it is put together is found twice, and again when it is put together otherwise; then all is let go."""
    found: list[int] = []
    original = meshes.topology_of

    def counted(source: Source, layers: Sequence[Float32Array]) -> Topology:
        found.append(source.vertices)
        return original(source, layers)

    empty_scene()
    grid = waving_grid("grid", textured=True)
    reader = SceneReader()
    monkeypatch.setattr(meshes, "topology_of", counted)
    counts = []
    for frame in range(20, 25):
        scene = bpy.context.scene
        scene.frame_set(frame)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        reader.read(depsgraph, scene, [], Changes(geometry={grid.session_uid}))
        counts.append(len(found))
    assert counts == [1, 2, 2, 2, 2]
    grid.data.polygons[3].flip()
    grid.data.update_tag()
    read_frame(reader, 25)
    assert len(found) == 4, "and by the one who reads it anew"
    bpy.data.objects.remove(grid)
    reader.read(bpy.context.evaluated_depsgraph_get(), scene, [], Changes(everything=True))
    assert not reader._meshes._topologies


def surface_of(mesh: MeshArrays) -> np.ndarray:
    """(triangles, 3, 6) places and normals."""
    both = np.concatenate([mesh.positions[mesh.corner_vertex], mesh.corner_normals], axis=1)
    return both[mesh.triangles]


def test_corners_that_were_alike_come_apart() -> None:
    """Sharp edges show nowhere on a plane, then here and there as waves come by."""
    empty_scene()
    grid = waving_grid("grid", sharp=True)
    grid.modifiers["Wave"].time_offset = 3.0
    reader = SceneReader()
    corners = set()
    for frame in (1, 2, 4, 5, 6, 8, 12, 20, 21):
        scene = bpy.context.scene
        scene.frame_set(frame)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        arrays = reader.read(depsgraph, scene, [], Changes(geometry={grid.session_uid}))
        (mesh,), (expected,) = used_meshes(arrays), used_meshes(extract_scene(depsgraph, scene, []))
        corners.add(len(mesh.corner_vertex))
        np.testing.assert_array_equal(surface_of(mesh), surface_of(expected))
    assert len(corners) > 1


def test_vertices_that_swap_corners_are_another_topology() -> None:
    empty_scene()
    grid = waving_grid("grid")
    reader = SceneReader()
    first = read_frame(reader, 20)
    grid.data.polygons[3].flip()
    grid.data.update_tag()
    assert not is_deformed(first, read_frame(reader, 20))
