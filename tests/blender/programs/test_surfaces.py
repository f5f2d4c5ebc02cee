# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes as channels of a material: what is constant, what a program sets, what is said."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from channels import channel
from curvrefl.curvrefl_addon.scene.arrays import Glass, MaterialArrays
from curvrefl.curvrefl_addon.scene.materials.node_links import Source
from curvrefl.curvrefl_addon.scene.programs.builder import Builder
from curvrefl.curvrefl_addon.scene.programs.expression import Expression
from curvrefl.curvrefl_addon.scene.programs.material_reader import MaterialReader, ReadMaterial
from curvrefl.curvrefl_addon.scene.programs.registry import HANDLERS

type Build = Callable[["Tree"], Any]


class NoImages:
    """Stands for the images of a scene that has none."""

    def index_of(self, node: Any, note: Any, splits_alpha: bool) -> int | None:
        return None


class Tree:
    """A node tree in few words."""

    def __init__(self, tree: Any) -> None:
        self.tree = tree

    def node(self, kind: str, output: str | int = 0, settings: dict[str, Any] | None = None, **inputs: Any) -> Any:
        """A new node's output; inputs are values or other nodes' outputs, named with _ for spaces."""
        node = self.tree.nodes.new("ShaderNode" + kind)
        for name, value in (settings or {}).items():
            setattr(node, name, value)
        for name, value in inputs.items():
            found = [socket for socket in node.inputs if name.replace("_", " ") in (socket.identifier, socket.name)]
            socket = found[0] if found else node.inputs[int(name[1:])]
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            else:
                socket.default_value = value
        return node.outputs[output]

    def varying(self) -> Any:
        """A number from 0 to 1 that differs from place to place."""
        return self.node("TexWhiteNoise", "Value")

    def mix(self, share: Any, first: Any, second: Any) -> Any:
        return self.node("MixShader", Fac=share, i1=first, i2=second)

    def add(self, first: Any, second: Any) -> Any:
        return self.node("AddShader", i0=first, i1=second)


def place(b: Builder, source: Source) -> Expression:
    """Stands for a texture."""
    return Expression("fract(s.position.x)", "float", None, 0.0, 1.0)


def read(build: Build) -> tuple[MaterialArrays, ReadMaterial]:
    """A material whose surface a function builds."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    material = bpy.data.materials.new("made")
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(build(Tree(tree)), output.inputs["Surface"])
    reader = MaterialReader(NoImages(), {**HANDLERS, "TEX_WHITE_NOISE": place})
    found = reader.read(material)
    return reader.materials[found.index], found


def channels(material: MaterialArrays) -> set[str]:
    return set() if material.program is None else set(material.program.shape.channels)


def causes(found: ReadMaterial, is_mirror: bool = True) -> list[str]:
    return [remark.cause for remark in found.remarks_as(is_mirror)]


def test_plain_materials_need_no_program() -> None:
    material, found = read(
        lambda t: t.node(
            "BsdfPrincipled",
            Base_Color=(0.1, 0.2, 2.0, 1.0),
            Metallic=1.5,
            Roughness=0.25,
            Emission_Color=(1.0, 0.5, 0.25, 1.0),
            Emission_Strength=2.0,
        )
    )
    assert material.program is None and not causes(found)
    assert (material.metallic, material.roughness, material.alpha) == (1.0, 0.25, 1.0)
    np.testing.assert_allclose(material.base_color, (0.1, 0.2, 2.0), rtol=1e-6)
    np.testing.assert_allclose(material.emission, (2.0, 1.0, 0.5), rtol=1e-6)
    assert not found.is_seen_through and not found.is_hidden


def test_only_what_varies_is_a_programs() -> None:
    material, found = read(lambda t: t.node("BsdfPrincipled", Roughness=t.varying(), Alpha=t.varying(), Metallic=0.5))
    assert channels(material) == {"roughness", "alpha"} and material.metallic == 0.5
    assert material.range_of("roughness") == (0.0, 1.0) and found.is_seen_through
    assert material.range_of("metallic") == (0.5, 0.5) and not causes(found)


@pytest.mark.parametrize(
    ("kind", "settings", "expected"),
    [
        ("BsdfGlass", {}, {"transmission": 1.0, "glass": Glass.GLASS}),
        ("BsdfRefraction", {}, {"transmission": 1.0, "glass": Glass.REFRACTION}),
        ("BsdfAnisotropic", {}, {"metallic": 1.0, "glossy_only": True}),
        ("BsdfMetallic", {}, {"metallic": 1.0, "glossy_only": False}),
        ("BsdfDiffuse", {}, {"specular_level": 0.0, "metallic": 0.0}),
        ("BsdfTranslucent", {}, {"specular_level": 0.0, "translucency": 1.0}),
        ("BsdfTransparent", {}, {"alpha": 0.0, "transparent_tint": (1.0, 1.0, 1.0)}),
        ("SubsurfaceScattering", {}, {"subsurface": 1.0, "specular_level": 0.0}),
        ("BsdfSheen", {}, {"sheen_weight": 1.0, "base_color": (0.0, 0.0, 0.0)}),
        ("Emission", {}, {"emission": (1.0, 1.0, 1.0), "base_color": (0.0, 0.0, 0.0)}),
        ("VolumeScatter", {}, {"base_color": (0.0, 0.0, 0.0), "alpha": 1.0}),
    ],
)
def test_kinds(kind: str, settings: dict[str, Any], expected: dict[str, Any]) -> None:
    material, _ = read(lambda t: t.node(kind, settings=settings))
    assert material.program is None
    assert {name: getattr(material, name) for name in expected} == expected


def shine(t: Tree, *color: float, strength: float = 1.0) -> Any:
    return t.node("Emission", Color=(*color, 1.0), Strength=strength)


def diffuse(t: Tree, *color: float) -> Any:
    return t.node("BsdfDiffuse", Color=(*color, 1.0))


def test_constant_mixes_are_constants() -> None:
    material, found = read(lambda t: t.mix(0.25, diffuse(t, 0.8, 0.4, 0.0), shine(t, 1.0, 2.0, 4.0)))
    assert material.program is None and not causes(found)
    np.testing.assert_allclose(material.base_color, (0.6, 0.3, 0.0), rtol=1e-6)
    np.testing.assert_allclose(material.emission, (0.25, 0.5, 1.0), rtol=1e-6)
    material, _ = read(lambda t: t.mix(1.0, diffuse(t, 0.8, 0.4, 0.0), t.node("BsdfGlass")))
    assert material.program is None and material.glass == Glass.GLASS


def test_transparency_is_alpha() -> None:
    material, found = read(
        lambda t: t.mix(t.varying(), t.node("BsdfTransparent", Color=(0.5, 0.5, 0.5, 1)), diffuse(t, 1.0, 0.5, 0.0))
    )
    assert channels(material) == {"alpha"} and material.transparent_tint == (0.5, 0.5, 0.5)
    assert not causes(found) and found.is_seen_through and not found.is_hidden
    nested, _ = read(
        lambda t: t.mix(
            0.5,
            t.mix(0.25, t.node("BsdfTransparent"), diffuse(t, 1.0, 1.0, 1.0)),
            t.node("BsdfTransparent", Color=(0.0, 0.5, 1.0, 1.0)),
        )
    )
    assert nested.program is None
    np.testing.assert_allclose(nested.alpha, 0.125)
    np.testing.assert_allclose(nested.transparent_tint, np.array((0.375, 0.625, 0.875)) / 0.875, rtol=1e-6)
    _, hidden = read(lambda t: t.mix(t.varying(), t.node("BsdfTransparent"), t.node("BsdfTransparent")))
    assert hidden.is_hidden


def test_other_mixes_are_by_chance() -> None:
    material, found = read(
        lambda t: t.mix(0.25, diffuse(t, 0.8, 0.4, 0.0), t.node("BsdfAnisotropic", Color=(0.8, 0.4, 0.0, 1)))
    )
    # (The color is that of both, and gloss does not matter where there is none.)
    assert channels(material) == {"metallic", "kind"} and not causes(found)
    assert material.program is not None and "random" in material.program.sampled
    assert material.program.shape.text.count("s.random") == 1


def test_nested_mixes_share_one_number() -> None:
    material, _ = read(
        lambda t: t.mix(
            0.25,
            diffuse(t, 0.8, 0.4, 0.0),
            t.mix(t.varying(), t.node("BsdfAnisotropic"), t.node("BsdfGlass")),
        )
    )
    assert material.program is not None
    text = material.program.shape.text
    assert text.count("chance_inside(") == 1 and "s.random" in text
    assert "nodes/chance.glsl" in material.program.shape.files


def test_sums() -> None:
    material, found = read(lambda t: t.add(diffuse(t, 0.2, 0.1, 0.0), shine(t, 1.0, 2.0, 3.0)))
    assert material.program is None and material.emission == (1.0, 2.0, 3.0) and not causes(found)
    material, _ = read(lambda t: t.add(diffuse(t, 0.25, 0.125, 0.0), diffuse(t, 0.5, 0.25, 0.5)))
    assert material.program is None and material.base_color == (0.75, 0.375, 0.5)
    material, found = read(lambda t: t.add(t.node("BsdfAnisotropic"), diffuse(t, 0.5, 0.25, 0.5)))
    assert "base_color" in channels(material)
    assert causes(found) == ["Rough gloss {of} that is added to another shader is drawn a little too bright."]
    _, found = read(lambda t: t.add(t.node("BsdfPrincipled"), t.node("BsdfPrincipled", Roughness=0.1)))
    assert any("added shaders" in cause for cause in causes(found))


def test_light_in_what_is_clear_is_half_of_the_samples() -> None:
    material, found = read(lambda t: t.add(shine(t, 1.0, 2.0, 4.0), t.node("BsdfTransparent", Color=(1, 0.5, 0, 1))))
    assert material.program is None and not causes(found)
    assert (material.alpha, material.emission) == (0.5, (2.0, 4.0, 8.0))
    assert material.transparent_tint == (2.0, 1.0, 0.0) and material.base_color == (0.0, 0.0, 0.0)


def test_what_cannot_be_drawn_is_said_once() -> None:
    _, found = read(lambda t: t.mix(0.5, t.node("BsdfToon"), t.node("BsdfToon")))
    assert causes(found) == ["Toon BSDF shaders {of} are drawn as the nearest plain surface."]
    _, found = read(lambda t: t.node("BsdfPrincipled", Roughness=t.node("AmbientOcclusion", "AO")))
    assert len(causes(found)) == 1 and causes(found)[0].startswith("Ambient Occlusion nodes {of} are ")


def test_volumes_that_absorb() -> None:
    def build(t: Tree) -> Any:
        output = next(node for node in t.tree.nodes if node.type == "OUTPUT_MATERIAL")
        volume = t.node("VolumeAbsorption", Color=(0.25, 0.5, 1.0, 1.0), Density=2.0)
        t.tree.links.new(volume, output.inputs["Volume"])
        return t.node("BsdfGlass")

    material, found = read(build)
    np.testing.assert_allclose(material.absorption, (1.5, 1.0, 0.0), rtol=1e-6)
    assert not causes(found)


GRID = np.linspace(0.05, 0.95, 7)
RANDOM = (np.arange(4096) + 0.5) / 4096


@pytest.mark.usefixtures("gpu")
def test_mixes_by_chance_are_exact_in_the_mean() -> None:
    material, _ = read(
        lambda t: t.mix(
            t.varying(),
            t.mix(0.25, t.node("BsdfAnisotropic", Color=(0.2, 0.4, 0.6, 1.0)), t.node("BsdfGlass")),
            diffuse(t, 0.8, 0.0, 0.4),
        )
    )
    for share in (0.0, 0.3, 1.0):
        metallic, transmission, color = (
            channel(material, name, share * 0.999999, 0.0, RANDOM)
            for name in ("metallic", "transmission", "base_color")
        )
        np.testing.assert_allclose(metallic.mean(0), 0.75 * (1.0 - share), atol=2e-3)
        np.testing.assert_allclose(transmission.mean(0), 0.25 * (1.0 - share), atol=2e-3)
        expected = (1.0 - share) * (0.75 * np.array((0.2, 0.4, 0.6)) + 0.25) + share * np.array((0.8, 0.0, 0.4))
        np.testing.assert_allclose(color.mean(0), expected, atol=2e-3)
        # Each sample is one of the three.
        assert len(np.unique(color.round(4), axis=0)) <= 3


@pytest.mark.usefixtures("gpu")
def test_light_and_holes_are_exact() -> None:
    material, _ = read(
        lambda t: t.mix(
            t.varying(),
            t.node("BsdfTransparent", Color=(0.5, 0.5, 0.5, 1)),
            t.mix(t.varying(), diffuse(t, 0.8, 0.4, 0.0), shine(t, 1.0, 2.0, 4.0)),
        )
    )
    share = GRID[:, None]
    np.testing.assert_allclose(channel(material, "alpha", GRID, 0.0)[:, 0], GRID, atol=1e-6)
    np.testing.assert_allclose(channel(material, "emission", GRID, 0.0), share * (1.0, 2.0, 4.0), atol=1e-5)
    np.testing.assert_allclose(channel(material, "base_color", GRID, 0.0), (1.0 - share) * (0.8, 0.4, 0.0), atol=1e-6)


@pytest.mark.usefixtures("gpu")
def test_thresholds_are_arithmetic() -> None:
    compared = {"operation": "GREATER_THAN"}
    material, found = read(
        lambda t: t.node("BsdfPrincipled", Alpha=t.node("Math", settings=compared, i0=t.varying(), i1=0.5))
    )
    assert found.is_seen_through and material.range_of("alpha") == (0.0, 1.0)
    np.testing.assert_array_equal(channel(material, "alpha", GRID, 0.0)[:, 0], GRID > 0.5)


@pytest.mark.usefixtures("gpu")
def test_mixes_by_angle() -> None:
    material, found = read(
        lambda t: t.mix(t.node("Fresnel", "Factor", IOR=1.5), diffuse(t, 0.8, 0.4, 0.0), t.node("BsdfAnisotropic"))
    )
    assert not causes(found)
    head_on, grazing = (channel(material, "metallic", 0.5, 0.0, RANDOM, cosine).mean() for cosine in (1.0, 0.05))
    assert head_on == pytest.approx(0.04, abs=1e-3) and grazing > 0.5


EVERYTHING = (
    "BsdfPrincipled", "BsdfDiffuse", "BsdfAnisotropic", "BsdfMetallic", "BsdfGlass", "BsdfRefraction",
    "BsdfTransparent", "BsdfTranslucent", "BsdfSheen", "BsdfToon", "BsdfHair", "BsdfHairPrincipled", "BsdfRayPortal",
    "SubsurfaceScattering", "Emission", "Background", "Holdout",
)  # fmt: skip


@pytest.mark.parametrize("kind", EVERYTHING)
@pytest.mark.usefixtures("gpu")
def test_all_inputs_may_vary(kind: str) -> None:
    def build(t: Tree) -> Any:
        output = t.node(kind)
        for socket in output.node.inputs:
            if socket.enabled and not socket.is_unavailable and socket.name not in ("Weight", "Normal", "Tangent"):
                t.tree.links.new(t.varying(), socket)
        if kind == "BsdfMetallic":
            output.node.fresnel_type = "PHYSICAL_CONDUCTOR"
        return t.mix(t.varying(), output, t.add(t.node("BsdfGlass"), t.node("Emission", Strength=t.varying())))

    material, _ = read(build)
    assert material.program is not None
    for name in material.program.shape.channels:
        values = channel(material, name, GRID, 0.0, 0.25)
        assert np.isfinite(values).all()
        low, high = material.range_of(name)
        assert values.min() >= low - 1e-5 and values.max() <= high + 1e-5
