# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials as read, against what Cycles shows of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays, SceneArrays
from extraction import (
    add,
    add_square,
    cycles_picture,
    empty_scene,
    extracted,
    look_down,
    material_of,
    mesh_of,
    new_material,
)

type Tree = bpy.types.NodeTree
type BuildColor = Callable[[Tree], Any]
"""Makes nodes; returns the output with the colour"""


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def node(tree: Tree, kind: str, inputs: dict[str | int, Any] | None = None, **properties: Any) -> Any:
    """A node with values set and links made."""
    made: Any = tree.nodes.new(kind)
    for name, value in properties.items():
        setattr(made, name, value)
    for name, value in (inputs or {}).items():
        socket = next((s for s in made.inputs if s.identifier == name), None) if isinstance(name, str) else None
        socket = socket or made.inputs[name]
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = value
    return made


COLOR = (0.6, 0.3, 0.1, 1.0)
OTHER = (0.2, 0.5, 0.9, 1.0)


def _mix(blend: str, factor: float) -> BuildColor:
    return lambda tree: node(
        tree,
        "ShaderNodeMix",
        {"Factor_Float": factor, "A_Color": COLOR, "B_Color": OTHER},
        data_type="RGBA",
        blend_type=blend,
    ).outputs[2]


def _ramp(tree: Tree) -> Any:
    value = node(tree, "ShaderNodeValue")
    value.outputs[0].default_value = 0.3
    ramp = node(tree, "ShaderNodeValToRGB", {"Fac": value.outputs[0]})
    ramp.color_ramp.elements[0].color = (1.0, 0.0, 0.5, 1.0)
    ramp.color_ramp.elements[1].color = (0.0, 1.0, 0.25, 1.0)
    return ramp.outputs["Color"]


def _group(tree: Tree) -> Any:
    inner = bpy.data.node_groups.new("half", "ShaderNodeTree")
    inner.interface.new_socket("In", in_out="INPUT", socket_type="NodeSocketColor")
    inner.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketColor")
    start, end = node(inner, "NodeGroupInput"), node(inner, "NodeGroupOutput")
    change = node(inner, "ShaderNodeGamma", {"Color": start.outputs[0], "Gamma": 2.0})
    inner.links.new(change.outputs[0], end.inputs[0])
    color = node(tree, "ShaderNodeRGB")
    color.outputs[0].default_value = COLOR
    through = node(tree, "NodeReroute", {0: color.outputs[0]})
    group = node(tree, "ShaderNodeGroup", node_tree=inner)
    tree.links.new(through.outputs[0], group.inputs[0])
    return group.outputs[0]


def _muted(tree: Tree) -> Any:
    made = node(tree, "ShaderNodeInvert", {"Color": COLOR})
    after = node(tree, "ShaderNodeGamma", {"Color": made.outputs[0], "Gamma": 3.0})
    after.mute = True
    return after.outputs[0]


CONSTANTS: dict[str, BuildColor] = {
    **{
        f"{blend} {factor}": _mix(blend, factor)
        for blend in ("MIX", "MULTIPLY", "ADD", "SCREEN")
        for factor in (0.3, 1.0)
    },
    **{blend: _mix(blend, 0.7) for blend in ("SUBTRACT", "DARKEN", "LIGHTEN", "DIFFERENCE")},
    "old mix": lambda tree: node(
        tree, "ShaderNodeMixRGB", {"Fac": 0.25, "Color1": COLOR, "Color2": OTHER}, blend_type="MULTIPLY"
    ).outputs[0],
    "gamma": lambda tree: node(tree, "ShaderNodeGamma", {"Color": COLOR, "Gamma": 2.2}).outputs[0],
    "invert": lambda tree: node(tree, "ShaderNodeInvert", {"Color": COLOR, "Fac": 0.8}).outputs[0],
    "contrast": lambda tree: node(
        tree, "ShaderNodeBrightContrast", {"Color": COLOR, "Bright": 0.1, "Contrast": 0.4}
    ).outputs[0],
    "hue": lambda tree: node(
        tree, "ShaderNodeHueSaturation", {"Color": COLOR, "Hue": 0.8, "Saturation": 0.7, "Value": 1.3, "Fac": 0.9}
    ).outputs[0],
    "gray": lambda tree: node(tree, "ShaderNodeRGBToBW", {"Color": COLOR}).outputs[0],
    "math": lambda tree: node(tree, "ShaderNodeMath", {0: 0.3, 1: 0.4}, operation="POWER").outputs[0],
    "ramp": _ramp,
    "group": _group,
    "muted": _muted,
}


def test_colors_that_nodes_make_are_those_of_cycles() -> None:
    """One emitting square per kind, in one picture of a pixel each; the view is wider than the pixel filter."""
    count = len(CONSTANTS)
    for index, (name, build) in enumerate(CONSTANTS.items()):
        square = add_square(name, 1.0)
        square.location = (index - 0.5 * (count - 1), 0.0, 0.0)
        tree, (emission,) = new_material(square, "ShaderNodeEmission")
        tree.links.new(build(tree), emission.inputs["Color"])
        emission.inputs["Strength"].default_value = 2.0
    look_down(count)
    scene = extracted()
    assert not scene.warnings
    picture = cycles_picture(5 * count, 5, 1)[2, 2::5]
    for index, name in enumerate(CONSTANTS):
        np.testing.assert_allclose(
            material_of(scene, name).emission, picture[index], rtol=2e-3, atol=1e-3, err_msg=name
        )


def smooth_image(name: str = "smooth", float_buffer: bool = True) -> bpy.types.Image:
    """16 x 8 pixels without symmetry."""
    height, width = 8, 16
    y, x = np.mgrid[0:height, 0:width]
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., 0] = 0.5 + 0.4 * np.sin(2.0 * np.pi * x / width)
    pixels[..., 1] = (y + 0.5) / height
    pixels[..., 2] = 0.5 + 0.4 * np.cos(2.0 * np.pi * (x / width + y / height))
    image = bpy.data.images.new(name, width, height, float_buffer=float_buffer)
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    return image


def texture_color(scene: SceneArrays, name: str, uv: np.ndarray) -> np.ndarray:
    """What the renderer's shader does (surface_color.glsl), for (h, w, 2) coordinates."""
    material = material_of(scene, name)
    image = scene.images[material.image]
    place = uv * np.array(material.uv_scale) + np.array(material.uv_offset)
    height, width = image.pixels.shape[:2]
    place = place * (width, height)
    if image.nearest:
        column, row = np.floor(place[..., 0]).astype(int), np.floor(place[..., 1]).astype(int)
        found = _texel(image.pixels, column, row, image.repeat)
    else:
        place = place - 0.5
        low = np.floor(place).astype(int)
        part = place - low
        found = sum(
            (part[..., 0:1] if dx else 1 - part[..., 0:1])
            * (part[..., 1:2] if dy else 1 - part[..., 1:2])
            * _texel(image.pixels, low[..., 0] + dx, low[..., 1] + dy, image.repeat)
            for dx in (0, 1)
            for dy in (0, 1)
        )
    return found[..., :3] * np.array(material.base_color)


def _texel(pixels: np.ndarray, column: np.ndarray, row: np.ndarray, repeat: bool) -> np.ndarray:
    height, width = pixels.shape[:2]
    if repeat:
        return pixels[row % height, column % width]
    return pixels[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)]


def _mapped(kind: str, turn: float = 0.0) -> BuildColor:
    def build(tree: Tree) -> Any:
        uv = node(tree, "ShaderNodeTexCoord").outputs["UV"]
        inputs = {"Vector": uv, "Scale": (2.0, 0.5, 1.0), "Rotation": (0.0, 0.0, turn)}
        mapping = node(tree, "ShaderNodeMapping", inputs, vector_type=kind)
        if kind != "VECTOR":
            mapping.inputs["Location"].default_value = (0.3, 0.1, 0.0)
        return node(tree, "ShaderNodeTexImage", {"Vector": mapping.outputs[0]}, image=smooth_image()).outputs["Color"]

    return build


def _image(float_buffer: bool) -> BuildColor:
    return lambda tree: node(tree, "ShaderNodeTexImage", image=smooth_image(float_buffer=float_buffer)).outputs["Color"]


def _non_color(tree: Tree) -> Any:
    image = smooth_image(float_buffer=False)
    image.colorspace_settings.name = "Non-Color"
    return node(tree, "ShaderNodeTexImage", image=image).outputs["Color"]


def _checker(tree: Tree) -> Any:
    uv = node(tree, "ShaderNodeUVMap").outputs["UV"]
    inputs = {"Vector": uv, "Scale": 5.0, "Color1": COLOR, "Color2": OTHER}
    return node(tree, "ShaderNodeTexChecker", inputs).outputs["Color"]


def _changed(tree: Tree) -> Any:
    texture = node(tree, "ShaderNodeTexImage", image=smooth_image()).outputs["Color"]
    gamma = node(tree, "ShaderNodeGamma", {"Color": texture, "Gamma": 1.5}).outputs[0]
    inputs = {"Factor_Float": 1.0, "A_Color": gamma, "B_Color": OTHER}
    return node(tree, "ShaderNodeMix", inputs, data_type="RGBA", blend_type="MULTIPLY").outputs[2]


def _extended(tree: Tree) -> Any:
    uv = node(tree, "ShaderNodeTexCoord").outputs["UV"]
    mapping = node(tree, "ShaderNodeMapping", {"Vector": uv, "Scale": (1.5, 1.5, 1.0)})
    texture = node(tree, "ShaderNodeTexImage", {"Vector": mapping.outputs[0]}, image=smooth_image(), extension="EXTEND")
    return texture.outputs["Color"]


def _generated(tree: Tree) -> Any:
    place = node(tree, "ShaderNodeTexCoord").outputs["Generated"]
    return node(tree, "ShaderNodeTexImage", {"Vector": place}, image=smooth_image()).outputs["Color"]


def _object_space(tree: Tree) -> Any:
    place = node(tree, "ShaderNodeTexCoord").outputs["Object"]
    return node(tree, "ShaderNodeTexImage", {"Vector": place}, image=smooth_image()).outputs["Color"]


TEXTURES: dict[str, BuildColor] = {
    "byte sRGB": _image(False),
    "float": _image(True),
    "non-color": _non_color,
    "closest": lambda tree: node(tree, "ShaderNodeTexImage", image=smooth_image(), interpolation="Closest").outputs[
        "Color"
    ],
    "mapped as point": _mapped("POINT"),
    "turned by half": _mapped("POINT", math.pi),
    "mapped as texture": _mapped("TEXTURE"),
    "mapped as vector": _mapped("VECTOR"),
    "extended": _extended,
    "checker": _checker,
    "changed": _changed,
    "generated": _generated,
    "object space": _object_space,
}


def test_textures_are_those_of_cycles() -> None:
    """Squares beside each other in one picture, read as base colours and then shown by emission."""
    pixels, count = 30, len(TEXTURES)
    shown = []
    for index, (name, build) in enumerate(TEXTURES.items()):
        square = add_square(name, 1.0)
        square.location = (index - 0.5 * (count - 1), 0.0, 0.0)
        tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
        color = build(tree)
        tree.links.new(color, shader.inputs["Color"])
        shown.append((tree, color))
    scene = extracted()
    for tree, color in shown:
        emission = node(tree, "ShaderNodeEmission", {"Color": color})
        tree.links.new(emission.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    look_down(count)
    picture = cycles_picture(pixels * count, pixels, 64)
    centers = (np.arange(pixels) + 0.5) / pixels
    local = np.stack(np.meshgrid(centers, centers), axis=-1)
    for index, name in enumerate(TEXTURES):
        uv = _interpolated_uv(scene, name, local)
        ours = texture_color(scene, name, uv)
        theirs = picture[:, index * pixels : (index + 1) * pixels]
        # The pixel filter blurs sharp edges, and the neighbour comes in at the border.
        error = np.abs(ours - theirs)[2:-2, 2:-2].max(axis=-1)
        quantile = 0.4 if name in ("closest", "checker") else 0.9
        # Between the texels of byte images Cycles interpolates before it decodes.
        limit = 0.035 if name == "byte sRGB" else 0.02
        assert np.quantile(error, quantile) < limit, (name, np.quantile(error, [0.4, 0.9, 1.0]))


def _interpolated_uv(scene: SceneArrays, name: str, local: np.ndarray) -> np.ndarray:
    """(h, w, 2) of the mesh's own coordinates, which are affine on a square of two triangles."""
    mesh = mesh_of(scene, name)
    assert mesh.corner_uv is not None
    places = mesh.positions[mesh.corner_vertex][:, :2] + 0.5
    affine, *_ = np.linalg.lstsq(np.column_stack([places, np.ones(len(places))]), mesh.corner_uv, rcond=None)
    return local @ affine[:2] + affine[2]


def test_the_principled_shader() -> None:
    cube = add("cube")
    tree, (shader,) = new_material(cube, "ShaderNodeBsdfPrincipled")
    for name, value in {
        "Base Color": COLOR,
        "Metallic": 0.25,
        "Roughness": 0.125,
        "IOR": 1.75,
        "Specular IOR Level": 0.375,
        "Emission Color": OTHER,
        "Emission Strength": 2.0,
    }.items():
        shader.inputs[name].default_value = value
    scene = extracted()
    material = material_of(scene, "cube")
    np.testing.assert_allclose(material.base_color, COLOR[:3], rtol=1e-6)
    np.testing.assert_allclose(material.emission, 2.0 * np.array(OTHER[:3]), rtol=1e-6)
    assert (material.metallic, material.roughness, material.ior, material.specular_level) == (0.25, 0.125, 1.75, 0.375)
    assert not material.glossy_only and not material.uses_vertex_color and material.image == -1
    assert not scene.warnings
    shader.inputs["Coat Weight"].default_value = 0.5
    node(tree, "ShaderNodeTexNoise")
    tree.links.new(tree.nodes["Noise Texture"].outputs[0], shader.inputs["Roughness"])
    scene = extracted()
    (warning,) = scene.warnings
    assert "Coat Weight" in warning and "Noise Texture" in warning and warning.count(".") == 1
    assert material_of(scene, "cube").roughness == pytest.approx(0.5)


def simple(kind: str, **inputs: Any) -> tuple[MaterialArrays, tuple[str, ...]]:
    """A cube with one shader node, read."""
    cube = add("cube")
    _, (shader,) = new_material(cube, kind)
    for name, value in inputs.items():
        shader.inputs[name].default_value = value
    scene = extracted()
    return material_of(scene, "cube"), scene.warnings


def test_other_shaders() -> None:
    material, warnings = simple("ShaderNodeBsdfDiffuse", Color=COLOR)
    assert (material.specular_level, material.metallic, warnings) == (0.0, 0.0, ())
    np.testing.assert_allclose(material.base_color, COLOR[:3], rtol=1e-6)


def test_the_glossy_shader() -> None:
    material, warnings = simple("ShaderNodeBsdfGlossy", Color=COLOR, Roughness=0.25)
    assert material.glossy_only and material.roughness == 0.25 and not warnings
    np.testing.assert_allclose(material.base_color, COLOR[:3], rtol=1e-6)


def test_the_emission_shader() -> None:
    material, warnings = simple("ShaderNodeEmission", Color=COLOR, Strength=3.0)
    np.testing.assert_allclose(material.emission, 3.0 * np.array(COLOR[:3]), rtol=1e-6)
    assert material.base_color == (0.0, 0.0, 0.0) and material.specular_level == 0.0 and not warnings


def test_an_unsupported_shader_warns_once_by_name() -> None:
    material, warnings = simple("ShaderNodeBsdfGlass", Roughness=0.0, IOR=1.33)
    assert material.base_color == (0.0, 0.0, 0.0)
    assert material.ior == pytest.approx(1.33)
    assert len(warnings) == 1 and '"cube"' in warnings[0]


def test_mixed_and_added_shaders() -> None:
    cube = add("cube")
    tree, (mix, diffuse, glossy) = new_material(
        cube, "ShaderNodeMixShader", "ShaderNodeBsdfDiffuse", "ShaderNodeBsdfGlossy"
    )
    tree.links.new(diffuse.outputs[0], mix.inputs[1])
    tree.links.new(glossy.outputs[0], mix.inputs[2])
    mix.inputs["Fac"].default_value = 1.0
    scene = extracted()
    assert material_of(scene, "cube").glossy_only and not scene.warnings
    mix.inputs["Fac"].default_value = 0.25
    scene = extracted()
    assert not material_of(scene, "cube").glossy_only and len(scene.warnings) == 1
    both = node(tree, "ShaderNodeAddShader")
    emission = node(tree, "ShaderNodeEmission", {"Color": OTHER, "Strength": 1.0})
    tree.links.new(emission.outputs[0], both.inputs[0])
    tree.links.new(diffuse.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    scene = extracted()
    np.testing.assert_allclose(material_of(scene, "cube").emission, OTHER[:3], rtol=1e-6)
    assert material_of(scene, "cube").base_color != (0.0, 0.0, 0.0) and not scene.warnings


def test_a_material_without_a_surface_shows_its_viewport_color() -> None:
    cube = add("cube")
    material = bpy.data.materials.new("plain")
    material.node_tree.nodes.clear()
    material.diffuse_color = (0.1, 0.2, 0.3, 1.0)
    cube.data.materials.append(material)
    np.testing.assert_allclose(material_of(extracted(), "cube").base_color, (0.1, 0.2, 0.3), rtol=1e-6)


def test_vertex_colors_times_a_texture() -> None:
    square = add_square()
    square.data.color_attributes.new("paint", "FLOAT_COLOR", "POINT")
    tree, (shader,) = new_material(square, "ShaderNodeBsdfPrincipled")
    texture = node(tree, "ShaderNodeTexImage", image=smooth_image()).outputs["Color"]
    paint = node(tree, "ShaderNodeAttribute", attribute_name="paint").outputs["Color"]
    inputs = {"Factor_Float": 1.0, "A_Color": texture, "B_Color": paint}
    product = node(tree, "ShaderNodeMix", inputs, data_type="RGBA", blend_type="MULTIPLY").outputs[2]
    tree.links.new(product, shader.inputs["Base Color"])
    scene = extracted()
    material = material_of(scene, "square")
    assert material.uses_vertex_color and material.image == 0
    assert material.base_color == (1.0, 1.0, 1.0)
    assert mesh_of(scene, "square").corner_color is not None and not scene.warnings


def test_one_image_in_many_materials_is_read_once() -> None:
    image = smooth_image()
    for name in ("one", "two"):
        square = add_square(name)
        tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
        tree.links.new(node(tree, "ShaderNodeTexImage", image=image).outputs[0], shader.inputs["Color"])
    scene = extracted()
    assert len(scene.images) == 1
    assert material_of(scene, "one").image == material_of(scene, "two").image == 0


def test_a_missing_image_is_magenta() -> None:
    square = add_square()
    tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    image = bpy.data.images.new("lost", 4, 4)
    image.source = "FILE"
    image.filepath = "/nowhere/lost.png"
    tree.links.new(node(tree, "ShaderNodeTexImage", image=image).outputs[0], shader.inputs["Color"])
    scene = extracted()
    np.testing.assert_array_equal(scene.images[0].pixels, [[(1.0, 0.0, 1.0, 1.0)]])
    assert any('"lost" has no pixels' in warning for warning in scene.warnings)


def test_a_packed_image(tmp_path: Any) -> None:
    path = tmp_path / "saved.png"
    made = smooth_image(float_buffer=False)
    made.filepath_raw = str(path)
    made.file_format = "PNG"
    made.save()
    packed = bpy.data.images.load(str(path))
    packed.pack()
    path.unlink()
    square = add_square()
    tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    tree.links.new(node(tree, "ShaderNodeTexImage", image=packed).outputs[0], shader.inputs["Color"])
    scene = extracted()
    assert scene.images[0].pixels.shape == (8, 16, 4)
    rows = np.arange(8) + 0.5
    encoded = np.rint(rows / 8 * 255) / 255
    np.testing.assert_allclose(scene.images[0].pixels[:, 0, 1], ((encoded + 0.055) / 1.055) ** 2.4, atol=4e-3)
    assert not scene.warnings
