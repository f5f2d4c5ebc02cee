# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One number that is none spoils nothing but what it belongs to, and a sentence says whose it is."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import fields, replace

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, LightArrays, MaterialArrays, SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes import placed_room

pytestmark = pytest.mark.usefixtures("gpu")
METHODS = ("exact", "newton", "environment_cube")
SIZE = (64, 48)
VISIBLE = 0.02
"""Of a color"""
NAN, INF, HUGE = math.nan, math.inf, 1e30

type Act = Callable[[], None]


def placed(name: str, x: float) -> Act:
    return lambda: setattr(bpy.data.objects[name], "location", (x, 0.0, 0.0))


def turned(name: str, x: float) -> Act:
    return lambda: setattr(bpy.data.objects[name], "rotation_euler", (x, 0.0, 0.0))


def stretched(name: str, x: float) -> Act:
    return lambda: setattr(bpy.data.objects[name], "scale", (x, x, x))


def vertices(name: str, x: float) -> Act:
    def act() -> None:
        for vertex in bpy.data.objects[name].data.vertices:
            vertex.co.x = x

    return act


def lamp(name: str, prop: str, value: object) -> Act:
    return lambda: setattr(bpy.data.lights[name], prop, value)


def painted(material: str, socket: str, value: object) -> Act:
    def act() -> None:
        inputs = bpy.data.materials[material].node_tree.nodes["Principled BSDF"].inputs
        inputs["Emission Strength"].default_value = 1.0
        inputs[socket].default_value = value

    return act


def lit(socket: str, value: object) -> Act:
    def act() -> None:
        bpy.data.worlds["World"].node_tree.nodes["Background"].inputs[socket].default_value = value

    return act


def picture(value: float) -> bpy.types.Image:
    image = bpy.data.images.new("Picture", 8, 4, float_buffer=True)
    pixels = np.full((4, 8, 4), 0.5, np.float32)
    pixels[1, 2, :3] = value
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    return image


def with_picture(value: float, of_world: bool) -> Act:
    def act() -> None:
        owner = bpy.data.worlds["World"] if of_world else bpy.data.materials["Gray"]
        tree = owner.node_tree
        node = tree.nodes.new("ShaderNodeTexEnvironment" if of_world else "ShaderNodeTexImage")
        node.image = picture(value)
        shader = tree.nodes["Background" if of_world else "Principled BSDF"]
        tree.links.new(node.outputs["Color"], shader.inputs["Color" if of_world else "Base Color"])

    return act


def bad_uv() -> None:
    with_picture(0.2, of_world=False)()
    bpy.data.objects["Floor"].data.uv_layers.active.uv[3].vector = (NAN, INF)


def bad_vertex_colors() -> None:
    mesh = bpy.data.objects["Floor"].data
    colors = mesh.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    colors.data[7].color = (NAN, INF, 0.0, 1.0)
    tree = bpy.data.materials["Gray"].node_tree
    node = tree.nodes.new("ShaderNodeVertexColor")
    node.layer_name = "Paint"
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])


LEFT_OUT: dict[str, tuple[Act, str]] = {
    "place NaN": (placed("Block 1", NAN), '"Block 1" is at no finite place'),
    "place 1e30": (placed("Block 1", HUGE), '"Block 1" lies farther out'),
    "rotation NaN": (turned("Block 1", NAN), '"Block 1" is at no finite place'),
    "scale 1e30": (stretched("Block 1", HUGE), '"Block 1" lies farther out'),
    "scale 1e-30": (stretched("Block 1", 1e-30), '"Block 1" is flattened'),
    "vertices NaN": (vertices("Block 1", NAN), '"Block 1" have a corner at no finite place'),
    "vertices infinite": (vertices("Block 1", INF), '"Block 1" have a corner at no finite place'),
    "vertices 1e30": (vertices("Block 1", HUGE), '"Block 1" have a corner at no finite place'),
}
LAMPS: dict[str, tuple[Act, str]] = {
    "energy NaN": (lamp("Point", "energy", NAN), 'Lamp "Point" is left out'),
    "energy infinite": (lamp("Point", "energy", INF), 'Lamp "Point" is left out'),
    "lamp color NaN": (lamp("Point", "color", (NAN, 1.0, 1.0)), 'Lamp "Point" is left out'),
    "radius NaN": (lamp("Point", "shadow_soft_size", NAN), 'Lamp "Point" is left out'),
    "lamp's place NaN": (placed("Point", NAN), 'Lamp "Point" is at no finite place'),
    "lamp's place 1e30": (placed("Point", HUGE), 'Lamp "Point" lies farther out'),
    "area size NaN": (lamp("Area", "size", NAN), 'Lamp "Area" is left out'),
    "sun angle NaN": (lamp("Sun", "angle", NAN), 'Lamp "Sun" is left out'),
}
OTHERWISE: dict[str, tuple[Act, str]] = {
    "world color NaN": (lit("Color", (NAN, 0.2, 0.2, 1.0)), 'of world "World" is not a usable number'),
    "world strength infinite": (lit("Strength", INF), 'of world "World" is not a usable number'),
    "world strength 1e30": (lit("Strength", HUGE), 'of world "World" is not a usable number'),
    "world image NaN": (with_picture(NAN, of_world=True), 'Pixels of image "Picture"'),
    "world image 3e38": (with_picture(3e38, of_world=True), 'Pixels of image "Picture"'),
    "image NaN": (with_picture(NAN, of_world=False), 'Pixels of image "Picture"'),
    "image infinite": (with_picture(INF, of_world=False), 'Pixels of image "Picture"'),
    "color NaN": (painted("Gray", "Base Color", (NAN, 0.2, 0.2, 1.0)), 'of material "Gray" is not'),
    "mirror color NaN": (
        painted("Chrome", "Base Color", (NAN, 0.2, 0.2, 1.0)),
        'of material "Chrome" is not',
    ),
    "roughness NaN": (painted("Gray", "Roughness", NAN), 'of material "Gray" is not'),
    "metallic NaN": (painted("Gray", "Metallic", NAN), 'of material "Gray" is not'),
    "IOR NaN": (painted("Gray", "IOR", NAN), 'of material "Gray" is not'),
    "emission infinite": (
        painted("Gray", "Emission Color", (INF, 0, 0, 1)),
        'of material "Gray" is not',
    ),
    "emission NaN": (painted("Gray", "Emission Strength", NAN), 'of material "Gray" is not'),
    "UV NaN": (bad_uv, 'Attributes of object "Floor" that are not'),
    "vertex color NaN": (bad_vertex_colors, 'Attributes of object "Floor" that are not'),
}
CAMERAS: dict[str, tuple[Act, str]] = {
    "place NaN": (placed("Eye", NAN), "is at no finite place"),
    "place 1e30": (placed("Eye", HUGE), "lies farther out"),
    "rotation NaN": (turned("Eye", NAN), "is at no finite place"),
    "lens NaN": (lambda: setattr(bpy.data.cameras["Eye"], "lens", NAN), "is not a usable number"),
    "shift NaN": (lambda: setattr(bpy.data.cameras["Eye"], "shift_x", NAN), "is not a usable number"),
}


def read(act: Act) -> tuple[SceneArrays, View]:
    """The scene after the act, whose numbers are all usable."""
    ball = placed_room.build()
    act()
    scene, view = placed_room.read(ball, SIZE)
    numbers = [scene.world.color, scene.world.rotation, [] if scene.world.image is None else scene.world.image]
    numbers += [image.read() for image in scene.images]
    for mesh in scene.meshes:
        layers = [mesh.positions, mesh.corner_normals, mesh.corner_uv, mesh.corner_attributes]
        numbers += [layer for layer in layers if layer is not None]
    for thing in (*scene.materials, *scene.lights, *scene.instances):
        numbers += [value for value in values_of(thing) if isinstance(value, (float, tuple, np.ndarray))]
    for number in numbers:
        assert (np.abs(np.asarray(number, np.float64)) <= 1e20).all()
    return scene, view


def values_of(thing: MaterialArrays | LightArrays | InstanceArrays) -> list[object]:
    """Of its fields, those with numbers in the program in its place. (`ranges` may be endless: they are not known.)"""
    values = [getattr(thing, item.name) for item in fields(thing) if item.name not in ("ranges", "values", "program")]
    program = getattr(thing, "program", None)
    return values if program is None else [*values, program.records]


def picture_of(scene: SceneArrays, view: View, method: str) -> np.ndarray:
    with warnings.catch_warnings():
        # (Of numpy's, where something has computed with them all the same.)
        warnings.simplefilter("error", RuntimeWarning)
        color = Renderer(scene, Settings(method=method, samples=1)).render(view).color()
    assert np.isfinite(color).all()
    return color


@pytest.fixture(scope="module")
def without(gpu: None) -> Iterator[dict[str, np.ndarray]]:
    """Pictures without Block 1, by the method."""
    scene, view = read(lambda: bpy.data.objects.remove(bpy.data.objects["Block 1"]))
    yield {method: picture_of(scene, view, method) for method in METHODS}


@pytest.mark.parametrize("name", LEFT_OUT)
def test_what_it_belongs_to_is_left_out(name: str) -> None:
    act, sentence = LEFT_OUT[name]
    scene, _ = read(act)
    assert "Block 1" not in [instance.object_name for instance in scene.instances]
    assert [sentence in text for text in scene.warnings] == [True]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("act", [placed("Block 1", NAN), placed("Block 1", 1e6)])
def test_all_else_is_drawn_as_without_it(act: Act, method: str, without: dict[str, np.ndarray]) -> None:
    """Also of what is only so far out that nothing of it is seen: the others keep their shadows."""
    color = picture_of(*read(act), method)
    assert (np.abs(color - without[method]).max(axis=-1) > VISIBLE).mean() <= 0.002


@pytest.mark.parametrize("name", LAMPS)
def test_a_lamp_without_numbers_is_left_out(name: str) -> None:
    act, sentence = LAMPS[name]
    scene, _ = read(act)
    assert len(scene.lights) == 2
    assert [sentence in text for text in scene.warnings] == [True]


@pytest.mark.parametrize("name", OTHERWISE)
def test_no_material_and_no_world_has_it(name: str) -> None:
    act, sentence = OTHERWISE[name]
    scene, view = read(act)
    assert [sentence in text for text in scene.warnings] == [True]
    if name in ("world image 3e38", "vertex color NaN"):
        picture_of(scene, view, "exact")


@pytest.mark.parametrize("name", CAMERAS)
def test_no_camera_looks_from_nowhere(name: str) -> None:
    act, sentence = CAMERAS[name]
    with pytest.raises(InputError, match=f'Camera "Eye" .*{sentence}'):
        read(act)


@pytest.mark.parametrize("act", [placed("Mirror Ball", NAN), placed("Mirror Ball", HUGE), vertices("Mirror Ball", NAN)])
def test_no_mirror_is_nowhere(act: Act) -> None:
    with pytest.raises(InputError, match='"Mirror Ball" '):
        read(act)


def test_the_largest_numbers_that_are_taken_give_a_picture() -> None:
    """The strongest lamp a hair's breadth above a surface, the brightest world, the brightest color, many mirrors."""

    def act() -> None:
        lamp("Point", "energy", 9e19)()
        lamp("Point", "shadow_soft_size", 1e-12)()
        placed("Point", 1.0)()
        bpy.data.objects["Point"].location.z = 1e-4
        lit("Color", (9e14, 1.0, 1.0, 1.0))()
        painted("Gray", "Base Color", (5e4, 5e4, 5e4, 1.0))()
        for number in range(1, 7):
            painted(f"Paint {number}", "Metallic", 1.0)()
        for material in ("Chrome", *(f"Paint {number}" for number in range(1, 7))):
            painted(material, "Base Color", (5e4, 5e4, 5e4, 1.0))()

    scene, view = read(act)
    scene = replace(scene, reflectors=tuple(instance.object_id for instance in scene.instances))
    picture_of(scene, view, "exact")
