# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers, films, tangents and glass of materials as read, and what is said of them."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from channels import channel_on
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.scene.arrays import Glass, MaterialArrays, SceneArrays
from curvrefl.curvrefl_addon.scene.programs.shaders.conductors import f82_reflectances, reflectances
from extraction import add, add_square, cycles_picture, empty_scene, extracted, look_down, material_of, new_material
from scene.color_nodes import COLOR, OTHER, node


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def cube_of(kind: str, properties: dict[str, Any] | None = None, **inputs: Any) -> tuple[bpy.types.Object, Any, Any]:
    """A cube with one shader node, the tree and the node."""
    cube = add("cube")
    cube.data.uv_layers.new(name="UVMap")
    tree, (shader,) = new_material(cube, kind)
    for name, value in (properties or {}).items():
        setattr(shader, name, value)
    for name, value in inputs.items():
        shader.inputs[name.replace("_", " ")].default_value = value
    return cube, tree, shader


def read(scene: SceneArrays) -> MaterialArrays:
    return material_of(scene, "cube")


LAYERS: dict[str, Any] = {
    "Specular_Tint": COLOR,
    "Coat_Weight": 0.75,
    "Coat_Roughness": 0.25,
    "Coat_IOR": 1.75,
    "Coat_Tint": OTHER,
    "Thin_Film_Thickness": 400.0,
    "Thin_Film_IOR": 1.25,
    "Anisotropic": 0.5,
    "Anisotropic_Rotation": 0.125,
}


def test_layers_of_the_principled_shader() -> None:
    cube, _, _ = cube_of("ShaderNodeBsdfPrincipled", **LAYERS)
    scene = extracted(cube)
    material = read(scene)
    np.testing.assert_allclose(material.specular_tint, COLOR[:3], rtol=1e-6)
    np.testing.assert_allclose(material.coat_tint, OTHER[:3], rtol=1e-6)
    assert (material.coat_weight, material.coat_roughness, material.coat_ior) == (0.75, 0.25, 1.75)
    assert (material.film_thickness, material.film_ior) == (400.0, 1.25)
    assert (material.anisotropy, material.anisotropic_rotation) == (0.5, 0.125)
    assert material.program is None
    assert not [warning for warning in scene.warnings if "material" in warning]
    assert [warning for warning in extracted().warnings if "material" in warning] == [
        'Anisotropy of material "cube" is left out where it is no mirror.',
        'The thin film of material "cube" is left out where it is no mirror.',
    ]


def test_what_is_seen_through_is_shown_in_full() -> None:
    cube_of("ShaderNodeBsdfPrincipled", Transmission_Weight=0.5, Thin_Wall=True, **LAYERS)
    scene = extracted()
    material = read(scene)
    assert (material.transmission, material.thin_wall, material.glass) == (0.5, True, Glass.PRINCIPLED)
    assert material.is_seen_through and not scene.warnings


def test_thin_sheets_let_light_out_on_both_sides() -> None:
    cube_of("ShaderNodeBsdfPrincipled", Thin_Wall=True, Subsurface_Weight=0.5, Subsurface_Anisotropy=0.5)
    scene = extracted()
    material = read(scene)
    assert (material.subsurface, material.translucency) == (0.0, 0.375) and not scene.warnings


@pytest.mark.usefixtures("gpu")
@pytest.mark.parametrize(
    ("properties", "turns"),
    [
        ({"direction_type": "RADIAL", "axis": "Z"}, (0.0, 0.0)),
        # About X it points along Y where Z is in the middle, and about Z it points along Y or X there.
        ({"direction_type": "UV_MAP", "uv_map": "UVMap"}, (-0.25, 0.0)),
    ],
)
def test_tangents(properties: dict[str, str], turns: tuple[float, float]) -> None:
    """As what the tangent about Z is turned by: at a place to the right, then at one below."""
    tree, (shader,) = new_material(add_square(), "ShaderNodeBsdfAnisotropic")
    shader.inputs["Anisotropy"].default_value, shader.inputs["Rotation"].default_value = -0.5, 0.125
    tree.links.new(node(tree, "ShaderNodeTangent", **properties).outputs[0], shader.inputs["Tangent"])
    scene = extracted(bpy.data.objects["square"])
    material = material_of(scene, "square")
    assert material.anisotropy == -0.5 and not scene.warnings
    found = channel_on(scene, "square", "anisotropic_rotation", [(0.5, 0.0), (0.0, -0.5)])[:, 0]
    np.testing.assert_allclose(found, 0.125 + np.array(turns), atol=1e-5)


@pytest.mark.parametrize(("strength", "is_same"), [(None, True), (0.7, True), (0.5, False)])
def test_normals_of_the_coat_alone_are_said(strength: float | None, is_same: bool) -> None:
    """Not so where it is the same node, or another one that makes the same."""
    _, tree, shader = cube_of("ShaderNodeBsdfPrincipled", Coat_Weight=0.5)
    image = bpy.data.images.new("image", 4, 4)
    bumps = []
    for value in (0.7, strength or 0.7):
        texture = node(tree, "ShaderNodeTexImage", image=image)
        bumps.append(node(tree, "ShaderNodeNormalMap", {"Color": texture.outputs[0], "Strength": value}))
    tree.links.new(bumps[0].outputs[0], shader.inputs["Normal"])
    tree.links.new(bumps[0 if strength is None else 1].outputs[0], shader.inputs["Coat Normal"])
    scene = extracted()
    assert read(scene).varies("normal")
    said = 'Normals of material "cube" that are its coat\'s alone are left out.'
    assert scene.warnings == (() if is_same else (said,))


def test_what_is_one_for_a_whole_material_is_said() -> None:
    _, tree, shader = cube_of("ShaderNodeBsdfPrincipled")
    texture = node(tree, "ShaderNodeTexWhiteNoise").outputs["Value"]
    thick = node(tree, "ShaderNodeMath", {0: texture, 1: 400.0}, operation="MULTIPLY").outputs[0]
    tree.links.new(thick, shader.inputs["Thin Film Thickness"])
    scene = extracted(bpy.data.objects["cube"])
    assert read(scene).film_thickness == 200.0 and read(scene).program is None
    cause = 'The thickness of the thin film of material "cube" differs from place to place and is drawn as one.'
    assert scene.warnings == (cause,)


def test_glass_and_refraction() -> None:
    for kind, glass in (("ShaderNodeBsdfGlass", Glass.GLASS), ("ShaderNodeBsdfRefraction", Glass.REFRACTION)):
        empty_scene()
        cube_of(kind, {"distribution": "GGX"}, Color=COLOR, Roughness=0.25, IOR=1.25)
        scene = extracted()
        material = read(scene)
        np.testing.assert_allclose(material.base_color, COLOR[:3], rtol=1e-6)
        assert (material.transmission, material.glass, material.roughness, material.ior) == (1.0, glass, 0.25, 1.25)
        assert not scene.warnings


@pytest.mark.parametrize("kind", ["ShaderNodeBsdfGlass", "ShaderNodeBsdfAnisotropic", "ShaderNodeBsdfMetallic"])
def test_other_distributions_are_said_where_they_matter(kind: str) -> None:
    for roughness, said in ((0.0, False), (0.5, True)):
        empty_scene()
        cube, _, _ = cube_of(kind, {"distribution": "BECKMANN"}, Roughness=roughness)
        about_ggx = 'Roughness of material "cube" is drawn by the distribution GGX, not by its own.'
        assert (about_ggx in extracted(cube).warnings) == said


def test_facets_that_lose_light_are_said() -> None:
    for distribution, roughness, said in (("GGX", 0.25, 0), ("GGX", 0.5, 1), ("MULTI_GGX", 0.5, 0)):
        empty_scene()
        cube, _, _ = cube_of("ShaderNodeBsdfPrincipled", {"distribution": distribution}, Metallic=1.0)
        cube.data.materials[0].node_tree.nodes[0].inputs["Roughness"].default_value = roughness
        assert sum("Multiscatter GGX" in warning for warning in extracted(cube).warnings) == said


BAD: dict[str, tuple[str, dict[str, Any], dict[str, Any]]] = {
    "negative roughness": ("Principled", {"Roughness": -0.5}, {"roughness": 0.0}),
    "large roughness": ("Glass", {"Roughness": 3.0}, {"roughness": 1.0}),
    "negative roughness that is squared": ("Refraction", {"Roughness": -0.5}, {"roughness": 0.5}),
    "no IOR": ("Glass", {"IOR": 0.0}, {"ior": 1e-5}),
    "a large IOR": ("Principled", {"IOR": 1000.0}, {"ior": 1000.0}),
    "a coat IOR below 1": ("Principled", {"Coat_Weight": 1.0, "Coat_IOR": 0.5}, {"coat_ior": 1.0}),
    "alpha above 1": ("Principled", {"Alpha": 2.0}, {"alpha": 1.0}),
    "metallic above 1": ("Principled", {"Metallic": 7.0}, {"metallic": 1.0}),
    "negative transmission": ("Principled", {"Transmission_Weight": -1.0}, {"transmission": 0.0}),
    "a negative film": ("Principled", {"Thin_Film_Thickness": -400.0}, {"film_thickness": 0.0}),
    "anisotropy above 1": ("Anisotropic", {"Anisotropy": 5.0}, {"anisotropy": 0.99}),
    "a negative tint": ("Transparent", {"Color": (-1.0, 0.5, 0.25, 1.0)}, {"transparent_tint": (0.0, 0.5, 0.25)}),
}


@pytest.mark.parametrize("name", BAD)
def test_numbers_out_of_range_count_as_in_cycles(name: str) -> None:
    kind, inputs, expected = BAD[name]
    cube, _, _ = cube_of(f"ShaderNodeBsdf{kind}")
    tree = cube.data.materials[0].node_tree
    for key, value in inputs.items():
        # (Inputs have limits of their own; what is plugged in has none.)
        socket = tree.nodes[0].inputs[key.replace("_", " ")]
        made = node(tree, "ShaderNodeRGB" if socket.type == "RGBA" else "ShaderNodeValue")
        made.outputs[0].default_value = value
        tree.links.new(made.outputs[0], socket)
    material = read(extracted(cube))
    for key, value in expected.items():
        assert getattr(material, key) == pytest.approx(value), key


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -float("inf")])
def test_what_is_no_number_is_said(bad: float) -> None:
    for name in ("Alpha", "Transmission Weight", "Coat Weight", "Coat Tint", "Anisotropic", "Thin Film Thickness"):
        empty_scene()
        cube, tree, shader = cube_of("ShaderNodeBsdfPrincipled", Coat_Weight=0.5)
        made = node(tree, "ShaderNodeValue")
        made.outputs[0].default_value = bad
        tree.links.new(made.outputs[0], shader.inputs[name])
        scene = extracted(cube) if name != "Alpha" else extracted()
        for material in scene.materials:
            names = [name for name in material.__slots__ if name != "ranges"]
            values = [value for value in map(material.__getattribute__, names) if value is not None]
            numbers = np.concatenate([np.ravel(value) for value in values if isinstance(value, (float, tuple))])
            assert np.isfinite(numbers).all(), name
        if np.isnan(bad):
            assert any("usable number" in warning for warning in scene.warnings), name


def test_conductors_are_those_of_cycles() -> None:
    """Tilted squares under an even sky show what they reflect at each angle."""
    metals = {"gold": ((0.18, 0.42, 1.37), (3.42, 2.35, 1.77)), "iron": ((2.93, 2.92, 2.82), (3.07, 2.93, 2.84))}
    scene = bpy.context.scene
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    angles = np.radians([0.0, 45.0, 70.0, 80.0, 84.0])
    places = [(name, angle) for name in metals for angle in angles]
    for index, (name, angle) in enumerate(places):
        square = add_square(f"{name} {index}", 1.0)
        square.location = (index - 0.5 * (len(places) - 1), 0.0, 0.0)
        square.rotation_euler = (angle, 0.0, 0.0)
        square.scale.y = 1.0 / np.cos(angle)
        _, (shader,) = new_material(square, "ShaderNodeBsdfMetallic")
        shader.fresnel_type = "PHYSICAL_CONDUCTOR"
        shader.inputs["Roughness"].default_value = 0.0
        shader.inputs["IOR"].default_value, shader.inputs["Extinction"].default_value = metals[name]
    look_down(len(places))
    # (Glossy bounces are what is asked for, of one mirror to the sky.)
    picture = cycles_picture(5 * len(places), 5, 4)[2, 2::5]
    read_scene = extracted()
    for index, (name, angle) in enumerate(places):
        material = material_of(read_scene, f"{name} {index}")
        cosine = np.array([np.cos(angle)])
        about = f"{name} at {np.degrees(angle):.0f} degrees"
        exact = reflectances(*(np.array(part) for part in metals[name]), cosine)[0]
        np.testing.assert_allclose(exact, picture[index], atol=2e-3, err_msg=about)
        drawn = f82_reflectances(np.array(material.base_color), np.array(material.specular_tint), cosine)[0]
        np.testing.assert_allclose(drawn, picture[index], atol=0.025, err_msg=about)


def test_a_conductor_that_no_metal_of_a_color_is_like_is_said() -> None:
    cube, _, _ = cube_of(
        "ShaderNodeBsdfMetallic", {"fresnel_type": "PHYSICAL_CONDUCTOR"}, IOR=(0.05, 8.0, 1.5), Extinction=(0, 0, 0)
    )
    assert any("physical conductor" in warning for warning in extracted(cube).warnings)


ABSORBING: dict[str, tuple[str, dict[str, Any]]] = {
    "absorption": ("ShaderNodeVolumeAbsorption", {"Color": COLOR, "Density": 1.5}),
    "coefficients": (
        "ShaderNodeVolumeCoefficients",
        {"Absorption Coefficients": (0.3, 1.2, 2.0), "Scatter Coefficients": (0.0, 0.0, 0.0)},
    ),
    "principled": (
        "ShaderNodeVolumePrincipled",
        {"Color": (0.0, 0.0, 0.0, 1.0), "Absorption Color": OTHER, "Density": 2.0},
    ),
}


def test_absorption_is_that_of_cycles() -> None:
    """Blocks that bend no light, above a floor that shines; seen from above."""
    depth = 0.5
    floor = add_square("floor", 10.0)
    floor.location.z = -2.0
    _, (shine,) = new_material(floor, "ShaderNodeEmission")
    shine.inputs["Color"].default_value, shine.inputs["Strength"].default_value = (1.0, 1.0, 1.0, 1.0), 1.0
    for index, (name, (kind, inputs)) in enumerate(ABSORBING.items()):
        block = add(name)
        # (Rays through the very middle would hit the edge between two triangles.)
        block.location, block.scale = (index - 0.93, 0.13, 0.0), (0.5, 0.5, 0.5 * depth)
        tree, (surface,) = new_material(block, "ShaderNodeBsdfRefraction")
        for key, value in {"Color": (1.0, 1.0, 1.0, 1.0), "IOR": 1.0, "Roughness": 0.0}.items():
            surface.inputs[key].default_value = value
        volume = node(tree, kind, inputs)
        tree.links.new(volume.outputs[0], tree.nodes["Material Output"].inputs["Volume"])
    look_down(3.0)
    scene = bpy.context.scene
    still = render_reference(scene, bpy.context.view_layer, 15, 5, 1, "full")
    picture = np.asarray(still.pixels)[2, 2::5, :3]
    arrays = extracted()
    assert not arrays.warnings
    for index, name in enumerate(ABSORBING):
        through = np.exp(-depth * np.array(material_of(arrays, name).absorption))
        np.testing.assert_allclose(through, picture[index], rtol=2e-3, atol=1e-3, err_msg=name)


@pytest.mark.parametrize(
    ("kind", "inputs"),
    [
        ("ShaderNodeVolumeScatter", {"Density": 1.0}),
        ("ShaderNodeVolumePrincipled", {"Density": 1.0}),
        ("ShaderNodeVolumeCoefficients", {}),
        ("ShaderNodeEmission", {}),
    ],
)
def test_volumes_that_do_more_than_absorb_are_said(kind: str, inputs: dict[str | int, Any]) -> None:
    cube, tree, _ = cube_of("ShaderNodeBsdfGlass")
    tree.links.new(node(tree, kind, inputs).outputs[0], tree.nodes["Material Output"].inputs["Volume"])
    scene = extracted(cube)
    assert read(scene).absorption == (0.0, 0.0, 0.0)
    assert scene.warnings == ('Volumes of material "cube" are not shown.',)


def test_absorption_between_surfaces_that_bend_nothing_is_said() -> None:
    """Not so within what hides it."""
    for alpha, said in ((0.5, ('Volumes of material "cube" are not shown.',)), (1.0, ())):
        empty_scene()
        _, tree, _ = cube_of("ShaderNodeBsdfPrincipled", Alpha=alpha)
        volume = node(tree, "ShaderNodeVolumeAbsorption")
        tree.links.new(volume.outputs[0], tree.nodes["Material Output"].inputs["Volume"])
        assert extracted().warnings == said


def test_volumes_are_mixed_and_added() -> None:
    _, tree, _ = cube_of("ShaderNodeBsdfGlass")
    parts = [
        node(tree, "ShaderNodeVolumeAbsorption", {"Color": (0.0, 0.5, 1.0, 1.0), "Density": density}).outputs[0]
        for density in (1.0, 4.0)
    ]
    half = node(tree, "ShaderNodeMixShader", {"Fac": 0.25, 1: parts[0], 2: parts[1]})
    both = node(tree, "ShaderNodeAddShader", {0: half.outputs[0], 1: parts[0]})
    tree.links.new(both.outputs[0], tree.nodes["Material Output"].inputs["Volume"])
    np.testing.assert_allclose(read(extracted()).absorption, np.array((1.0, 0.5, 0.0)) * 2.75, rtol=1e-6)


def test_bounces_and_visibility_through_glass() -> None:
    cube, _, _ = cube_of("ShaderNodeBsdfGlass")
    cube.visible_transmission = False
    cycles = bpy.context.scene.cycles
    cycles.max_bounces, cycles.transmission_bounces, cycles.transparent_max_bounces = 5, 7, 9
    scene = extracted()
    assert not scene.instances[0].visible_transmission
    # (All bounces together are limited, too; what goes straight on is none.)
    assert (scene.transmission_bounces, scene.transparent_bounces) == (5, 9)
    cycles.transmission_bounces = 3
    assert extracted().transmission_bounces == 3
    cube.visible_transmission = True
    for rays in ("camera", "glossy", "shadow", "diffuse"):
        setattr(cube, f"visible_{rays}", False)
    (instance,) = extracted().instances
    assert instance.visible_transmission and not instance.visible_camera
