# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked looks of materials: what Cycles bakes, what stays as it was, and when a look holds."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, ClassVar

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.arrays import ImageSource
from curvrefl.curvrefl_addon.scene.programs import looks
from curvrefl.curvrefl_addon.scene.programs.looks import UV_MAP, look_of, may_help, signature
from curvrefl.curvrefl_addon.scene.programs.material_reader import MaterialReader
from curvrefl.curvrefl_addon.scene.programs.program import UV, Attribute
from curvrefl.operators.bake_look import CLASSES
from curvrefl.operators.looks.bake import bake_look
from curvrefl.operators.looks.channels import Shining, is_noisy
from curvrefl.operators.looks.unwrap import is_layout

COUNTED = ("materials", "images", "scenes", "objects", "meshes", "node_groups", "worlds")


@pytest.fixture(autouse=True)
def operators() -> Iterator[None]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.cycles.device = "CPU"
    missing = [cls for cls in CLASSES if not hasattr(bpy.types, cls.__name__)]
    for cls in missing:
        bpy.utils.register_class(cls)
    yield
    for cls in missing:
        bpy.utils.unregister_class(cls)


def counts() -> dict[str, int]:
    return {name: len(getattr(bpy.data, name)) for name in COUNTED}


def cube(material: bpy.types.Material, name: str = "Cube", x: float = 0.0) -> bpy.types.Object:
    bpy.ops.mesh.primitive_cube_add(location=(x, 0.0, 0.0))
    made = bpy.context.object
    made.name = name
    made.data.materials.append(material)
    return made


def rust() -> tuple[bpy.types.Material, Any]:
    """Its base color and roughness are halves of an ambient occlusion's color, its metallic is 0.3."""
    material = bpy.data.materials.new("Rust")
    tree = material.node_tree
    shader = tree.nodes["Principled BSDF"]
    node = tree.nodes.new("ShaderNodeAmbientOcclusion")
    node.inputs["Color"].default_value = (0.5, 0.25, 0.75, 1.0)
    tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    math = tree.nodes.new("ShaderNodeMath")
    math.operation = "MULTIPLY"
    math.inputs[1].default_value = 0.6
    tree.links.new(node.outputs["AO"], math.inputs[0])
    tree.links.new(math.outputs[0], shader.inputs["Roughness"])
    shader.inputs["Metallic"].default_value = 0.3
    return material, node


def bake(material: bpy.types.Material, **settings: Any) -> Any:
    assert bpy.ops.curvrefl.bake_look(material=material.name, **{"resolution": 64, "samples": 4, **settings}) == {
        "FINISHED"
    }
    found = look_of(material)
    assert found is not None and found.is_current
    return found


def middles(image: bpy.types.Image, item: bpy.types.Object) -> np.ndarray:
    """(faces, 3) what the image holds in the middle of each face, as it is stored."""
    pixels = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)
    layer = item.data.uv_layers[UV_MAP]
    found = []
    for face in item.data.polygons:
        u, v = np.mean([layer.uv[loop].vector for loop in face.loop_indices], axis=0)
        found.append(pixels[int(v * image.size[1]), int(u * image.size[0]), :3])
    return np.array(found)


def encoded(linear: tuple[float, ...]) -> np.ndarray:
    color = np.array(linear)
    return np.where(color <= 0.0031308, 12.92 * color, 1.055 * color ** (1 / 2.4) - 0.055)


def test_channels_are_what_cycles_makes_of_them_and_the_file_is_as_it_was() -> None:
    material, _ = rust()
    item, other = cube(material), cube(bpy.data.materials.new("Other"), "Other", 50.0)
    active, before = bpy.context.object, counts()
    look = bake(material)
    assert middles(look.images["base_color"], item) == pytest.approx(
        np.tile(encoded((0.5, 0.25, 0.75)), (6, 1)), abs=0.01
    )
    assert middles(look.images["surface"], item) == pytest.approx(np.tile([0.3, 0.6, 1.0], (6, 1)), abs=0.01)
    assert set(look.images) == {"base_color", "surface"}
    assert all(image.packed_file is not None for image in look.images.values())
    changed = {name: count - before[name] for name, count in counts().items() if count != before[name]}
    assert changed == {"materials": 1, "images": 2}
    assert item.data.materials[:] == [material] and UV_MAP not in other.data.uv_layers
    assert bpy.context.object == active and [one.name for one in bpy.context.selected_objects] == ["Other"]
    assert item.data.uv_layers.active.name == "UVMap" and item.data.uv_layers["UVMap"].active_render


def test_the_look_is_a_principled_of_images(tmp_path: Path) -> None:
    material, _ = rust()
    cube(material)
    bake(material)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    look = look_of(bpy.data.materials["Rust"])
    assert look is not None and look.is_current
    shader = next(node for node in look.material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    assert {socket.name for socket in shader.inputs if socket.is_linked} == {"Base Color", "Roughness"}
    assert shader.inputs["Metallic"].default_value == pytest.approx(0.3) and shader.inputs["Alpha"].default_value == 1.0
    assert look.images["base_color"].has_data or look.images["base_color"].packed_file


def test_a_look_holds_until_the_nodes_change() -> None:
    material, node = rust()
    cube(material)
    bake(material)
    node.location.x += 100.0
    node.label = "moved"
    assert look_of(material).is_current
    node.inside = True
    assert not look_of(material).is_current
    node.inside = False
    assert look_of(material).is_current
    material.node_tree.nodes["Principled BSDF"].inputs["Metallic"].default_value = 0.4
    assert not look_of(material).is_current
    before = counts()
    bake(material)
    assert counts() == before
    assert bpy.ops.curvrefl.forget_look(material="Rust") == {"FINISHED"}
    assert look_of(material) is None and counts()["images"] == before["images"] - 2


class Images:
    """Stands for the list of images."""

    images: ClassVar[list[ImageSource]] = []

    def __init__(self) -> None:
        self.asked: list[bpy.types.Image] = []

    def index_of(self, node: Any, _note: Any, _splits_alpha: bool) -> int | None:
        self.asked.append(node.image)
        return len(self.asked) - 1


def test_a_look_is_read_in_place_of_the_nodes() -> None:
    material, node = rust()
    cube(material)
    look = bake(material)
    images = Images()
    reader = MaterialReader(images)
    found = reader.read(material)
    assert not found.remarks and set(images.asked) == set(look.images.values())
    assert Attribute(UV, UV_MAP) in reader.materials[found.index].program.attributes
    node.inside = True
    images = Images()
    causes = [remark.cause for remark in MaterialReader(images).read(material).remarks]
    assert looks.OUT_OF_DATE in causes and any("Ambient Occlusion" in cause for cause in causes) and not images.asked


def test_signatures_see_groups_ramps_and_links() -> None:
    tree = bpy.data.materials.new("m").node_tree
    ramp = tree.nodes.new("ShaderNodeValToRGB")
    group = tree.nodes.new("ShaderNodeGroup")
    group.node_tree = bpy.data.node_groups.new("g", "ShaderNodeTree")
    value = group.node_tree.nodes.new("ShaderNodeValue")
    curve = tree.nodes.new("ShaderNodeRGBCurve")
    seen = {signature(tree)}

    def is_new() -> bool:
        count = len(seen)
        seen.add(signature(tree))
        return len(seen) == count + 1

    ramp.color_ramp.elements[0].position = 0.3
    assert is_new()
    value.outputs[0].default_value = 2.0
    assert is_new()
    curve.mapping.curves[0].points[1].location = (0.9, 0.8)
    assert is_new()
    tree.links.new(ramp.outputs[0], tree.nodes["Principled BSDF"].inputs["Base Color"])
    assert is_new()
    assert not is_new()


def test_objects_with_the_material_have_places_of_their_own() -> None:
    """Two cubes, one of which has another material on half of its faces: 9 faces in one image."""
    material, node = rust()
    one, two = cube(material), cube(material, "Two", 5.0)
    two.data.materials.append(bpy.data.materials.new("Other"))
    for face in list(two.data.polygons)[:3]:
        face.material_index = 1
    material.node_tree.nodes["Principled BSDF"].inputs["Emission Strength"].default_value = 1.0
    info = material.node_tree.nodes.new("ShaderNodeObjectInfo")
    material.node_tree.links.new(info.outputs["Location"], node.inputs["Color"])
    look = bake(material)
    assert middles(look.images["base_color"], one) == pytest.approx(np.zeros((6, 3)), abs=0.01)
    assert middles(look.images["base_color"], two)[3:, 0] == pytest.approx(np.ones(3), abs=0.01)
    triangles = []
    for item, faces in ((one, range(6)), (two, range(3, 6))):
        layer = item.data.uv_layers[UV_MAP]
        for number in faces:
            uv = np.array([layer.uv[loop].vector for loop in item.data.polygons[number].loop_indices])
            triangles += [uv[[0, 1, 2]], uv[[0, 2, 3]]]
    assert is_layout(np.array(triangles))
    assert two.data.materials[1].name == "Other"


def test_mixed_shaders_in_groups() -> None:
    """A quarter of nothing, of the rest half gold and half paint."""
    material = bpy.data.materials.new("Mixed")
    tree = material.node_tree
    inner = bpy.data.node_groups.new("inner", "ShaderNodeTree")
    inner.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    gold, paint = inner.nodes.new("ShaderNodeBsdfAnisotropic"), inner.nodes.new("ShaderNodeBsdfDiffuse")
    gold.inputs["Color"].default_value, gold.inputs["Roughness"].default_value = (0.9, 0.6, 0.2, 1.0), 0.2
    paint.inputs["Color"].default_value = (0.1, 0.2, 0.8, 1.0)
    half, end = inner.nodes.new("ShaderNodeMixShader"), inner.nodes.new("NodeGroupOutput")
    inner.links.new(gold.outputs[0], half.inputs[1])
    inner.links.new(paint.outputs[0], half.inputs[2])
    inner.links.new(half.outputs[0], end.inputs[0])
    group, clear, mix = (tree.nodes.new(f"ShaderNode{name}") for name in ("Group", "BsdfTransparent", "MixShader"))
    group.node_tree = inner
    mix.inputs[0].default_value = 0.75
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(group.outputs[0], mix.inputs[2])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    item = cube(material)
    before = counts()
    look = bake(material)
    color = np.tile(encoded((0.5, 0.4, 0.5)), (6, 1))
    assert middles(look.images["base_color"], item) == pytest.approx(color, abs=0.015)
    assert middles(look.images["surface"], item) == pytest.approx(np.tile([0.5, 0.6, 0.75], (6, 1)), abs=0.015)
    assert counts()["node_groups"] == before["node_groups"]


def test_bumps_become_normals() -> None:
    material, _ = rust()
    tree = material.node_tree
    checker, bump = tree.nodes.new("ShaderNodeTexNoise"), tree.nodes.new("ShaderNodeBump")
    bump.inputs["Distance"].default_value = 0.5
    tree.links.new(checker.outputs[0], bump.inputs["Height"])
    tree.links.new(bump.outputs[0], tree.nodes["Principled BSDF"].inputs["Normal"])
    cube(material)
    normals = bake(material, resolution=128).images["normal"]
    values = np.array(normals.pixels[:]).reshape(-1, 4)[:, :3]
    assert values[:, :2].std() > 0.05
    lengths = np.linalg.norm(2.0 * values - 1.0, axis=1)
    assert np.median(np.abs(lengths - 1.0)) < 0.02


def test_samples_are_for_what_follows_rays() -> None:
    material, _ = rust()
    tree = material.node_tree
    assert is_noisy(tree, False) and not is_noisy(tree, True)
    bevel = tree.nodes.new("ShaderNodeBevel")
    assert not is_noisy(tree, True)
    tree.links.new(bevel.outputs[0], tree.nodes["Principled BSDF"].inputs["Normal"])
    assert is_noisy(tree, True)
    image = bpy.data.images.new("i", 4, 4)
    material.node_tree.nodes["Principled BSDF"].inputs["Emission Strength"].default_value = 1.0
    shining = Shining(material, image, "emission")
    assert not shining.is_noisy
    shining.remove()


def test_a_closed_bake_leaves_nothing_behind() -> None:
    """As Esc does between two images."""
    material, _ = rust()
    item = cube(material)
    before, scene = counts(), bpy.context.scene
    baking = bake_look(scene, bpy.context.view_layer, material, 32, 1)
    assert [next(baking).holds, next(baking).holds] == ["base_color", "surface"]
    assert counts()["images"] == before["images"] + 1
    baking.close()
    assert counts() == before and look_of(material) is None
    assert UV_MAP not in item.data.uv_layers and item.data.materials[:] == [material]


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda item: setattr(item, "hide_render", True), "No mesh that is rendered has the material"),
        (lambda item: [item.data.uv_layers.new() for _ in range(7)], "has 8 UV maps"),
        (lambda item: item.data.materials[0].node_tree.nodes.clear(), "has no shader to bake"),
    ],
)
def test_what_cannot_be_baked_is_refused(spoil: Any, sentence: str) -> None:
    material, _ = rust()
    spoil(cube(material))
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.curvrefl.bake_look(material="Rust", resolution=16)
    with pytest.raises(RuntimeError, match="There is no material"):
        bpy.ops.curvrefl.bake_look(material="None such")


def test_layouts() -> None:
    square = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
    assert is_layout(square * 0.5)
    assert not is_layout(np.concatenate([square * 0.5, square * 0.4]))
    assert not is_layout(square * 1.5)
    assert not is_layout(np.zeros((4, 3, 2)))


def test_what_a_look_helps_with() -> None:
    assert may_help("Wireframe nodes {of} are not drawn.")
    assert not may_help("Volumes {of} are not shown.") and not may_help(looks.OUT_OF_DATE)
