# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stills by Blender's engines: right light, right pixels, and a scene that is left as it was."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.report import cycles_reference
from curvrefl.curvrefl_addon.report.cycles_reference import Still, render_peer, render_reference
from curvrefl.curvrefl_addon.report.geometry_reference import render_geometry
from curvrefl.curvrefl_addon.report.images import load_exr, save_exr, save_png
from curvrefl.curvrefl_addon.scene.opened.temporary_settings import temporary_settings

WIDTH, HEIGHT = 16, 12


def principled(name: str, **inputs: Any) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    shader = material.node_tree.nodes["Principled BSDF"]
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return material


@pytest.fixture
def scene() -> bpy.types.Scene:
    """A wide gray floor that fills the picture, seen from above, under a sun of irradiance 2 W/m2."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)
    bpy.ops.mesh.primitive_plane_add(size=100)
    floor = bpy.context.object
    floor.name = "floor"
    floor.data.materials.append(principled("gray", Base_Color=(0.5, 0.4, 0.3, 1), Specular_IOR_Level=0.0))
    bpy.ops.object.light_add(type="SUN", location=(0, 0, 5))
    bpy.context.object.data.energy = 2.0
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (0, 0, 6)
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.context.view_layer.update()
    return scene


def state_of_file() -> dict[str, Any]:
    """Every simple property of every datablock (with the structs inside it) and the names of all datablocks."""
    state: dict[str, Any] = {}

    def read(owner: Any, path: str, depth: int) -> None:
        for prop in owner.bl_rna.properties:
            name = prop.identifier
            if name == "use_nodes":  # always true, and deprecated
                continue
            if prop.type in ("BOOLEAN", "INT", "FLOAT", "STRING", "ENUM"):
                value = getattr(owner, name)
                state[f"{path}.{name}"] = value if isinstance(value, str | int | float) else tuple(np.ravel(value))
            elif prop.type == "POINTER" and name not in ("rna_type", "original", "id_data", "depsgraph"):
                inner = getattr(owner, name)
                if isinstance(inner, bpy.types.ID):
                    state[f"{path}.{name}"] = inner.name_full
                elif inner is not None and depth < 3:
                    read(inner, f"{path}.{name}", depth + 1)

    for kind in ("scenes", "objects", "materials", "worlds", "lights", "cameras", "meshes", "curves", "collections"):
        collection = getattr(bpy.data, kind)
        state[kind] = sorted(collection.keys())
        for block in collection:
            read(block, f"{kind}.{block.name}", 0)
    for scene in bpy.data.scenes:
        for layer in scene.view_layers:
            read(layer, f"{scene.name}.{layer.name}", 0)
        for marker in scene.timeline_markers:
            read(marker, f"{scene.name}.{marker.name}", 0)
    for obj in bpy.data.objects:
        for modifier in obj.modifiers:
            read(modifier, f"{obj.name}.{modifier.name}", 0)
        state[f"{obj.name} slots"] = [slot.material.name if slot.material else None for slot in obj.material_slots]
    state["images"] = sorted(bpy.data.images.keys())
    return state


def differences(before: dict[str, Any], after: dict[str, Any]) -> dict[str, Any]:
    # An empty color space is one that Blender has not set up yet; it does when an EXR is first chosen.
    return {
        key: (before.get(key), after.get(key))
        for key in before.keys() | after.keys()
        if before.get(key) != after.get(key) and not (key.endswith("colorspace_settings.name") and not before[key])
    }


def make_eventful(scene: bpy.types.Scene) -> None:
    """Settings of a user's file that a still must not follow, and must not lose."""
    render = scene.render
    render.engine = "BLENDER_WORKBENCH"
    render.resolution_x, render.resolution_y, render.resolution_percentage = 1920, 1080, 37
    render.use_border, render.use_crop_to_border, render.border_max_x = True, True, 0.25
    render.film_transparent, render.use_stamp, render.use_motion_blur = True, True, True
    render.filepath = "//user_output_"
    render.image_settings.media_type, render.image_settings.file_format = "IMAGE", "PNG"
    render.image_settings.color_depth, render.image_settings.color_mode = "16", "BW"
    scene.cycles.samples, scene.cycles.film_exposure, scene.cycles.max_bounces = 77, 4.0, 9
    scene.view_settings.exposure = 3.0
    scene.camera.data.dof.use_dof, scene.camera.data.dof.aperture_fstop = True, 0.1
    chosen = scene.camera
    marker = scene.timeline_markers.new("cut", frame=1)
    elsewhere = bpy.data.objects.new("elsewhere", bpy.data.cameras.new("elsewhere"))
    elsewhere.location = (0, 0, -50)
    scene.collection.objects.link(elsewhere)
    marker.camera = elsewhere
    scene.camera = chosen
    bpy.ops.mesh.primitive_cube_add(size=4, location=(0, 0, 2))
    bpy.context.object.hide_render = True
    subdivision = bpy.data.objects["floor"].modifiers.new("subdivision", "SUBSURF")
    subdivision.levels, subdivision.render_levels, subdivision.show_render = 0, 2, False
    bpy.data.objects["floor"].pass_index = 12
    bpy.context.view_layer.material_override = principled("clay")
    bpy.context.view_layer.material_override = None
    bpy.context.view_layer.update()


def test_light_of_a_sun_on_a_diffuse_floor(scene: bpy.types.Scene) -> None:
    """Radiance = base color * irradiance / pi, in closed form."""
    still = render_reference(scene, bpy.context.view_layer, WIDTH, HEIGHT, 16)
    assert still.pixels.shape == (HEIGHT, WIDTH, 4)
    expected = np.array([0.5, 0.4, 0.3]) * 2.0 / np.pi
    assert still.pixels[..., :3].mean(axis=(0, 1)) == pytest.approx(expected, rel=0.01)
    assert still.seconds > 0.0


@pytest.mark.parametrize(("light", "bounced"), [("direct", False), ("full", True)])
def test_direct_light_has_no_second_diffuse_bounce(scene: bpy.types.Scene, light: str, bounced: bool) -> None:
    """A wall lit by the sun through no path but the floor: black in direct light."""
    scene.cycles.diffuse_bounces = 4
    bpy.data.objects["Sun"].rotation_euler = (np.radians(60.0), 0, 0)  # shines towards +Y, the wall's back
    bpy.ops.mesh.primitive_cube_add(size=2, location=(0, 0, 1))
    bpy.context.object.data.materials.append(principled("wall", Base_Color=(0.8, 0.8, 0.8, 1), Specular_IOR_Level=0.0))
    scene.camera.location, scene.camera.rotation_euler = (0, 3, 1), (np.radians(90.0), 0, np.radians(180.0))
    still = render_reference(scene, bpy.context.view_layer, WIDTH, HEIGHT, 16, light)
    in_shadow = still.pixels[HEIGHT // 2, WIDTH // 2, :3]
    assert bool(in_shadow.max() > 1e-3) == bounced


def test_a_mirror_shows_its_surroundings_lit_and_nothing_twice(scene: bpy.types.Scene) -> None:
    """The floor as seen in a mirror above it has the floor's own radiance; a mirror in the mirror shows no floor."""
    mirror = principled("mirror", Base_Color=(1, 1, 1, 1), Metallic=1.0, Roughness=0.0)
    bpy.ops.mesh.primitive_plane_add(size=4, location=(0, 0, 8), rotation=(np.pi, 0, 0))
    bpy.context.object.data.materials.append(mirror)
    bpy.data.objects["Sun"].rotation_euler = (np.radians(45.0), 0, 0)
    scene.camera.rotation_euler = (np.pi, 0, 0)
    still = render_reference(scene, bpy.context.view_layer, WIDTH, HEIGHT, 16)
    expected = np.array([0.5, 0.4, 0.3]) * 2.0 * np.cos(np.radians(45.0)) / np.pi
    assert still.pixels[HEIGHT // 2, WIDTH // 2, :3] == pytest.approx(expected, rel=0.02)

    bpy.data.objects["floor"].data.materials[0] = mirror
    still = render_reference(scene, bpy.context.view_layer, WIDTH, HEIGHT, 16)
    assert still.pixels[HEIGHT // 2, WIDTH // 2, :3] == pytest.approx([0, 0, 0], abs=1e-6)


def test_user_settings_are_not_followed_and_not_lost(scene: bpy.types.Scene) -> None:
    plain = render_reference(scene, bpy.context.view_layer, WIDTH, HEIGHT, 4).pixels
    make_eventful(scene)
    before = state_of_file()
    still = render_reference(scene, bpy.context.view_layer, WIDTH, HEIGHT, 4).pixels
    assert differences(before, state_of_file()) == {}
    assert still == pytest.approx(plain, abs=1e-5)


def test_geometry_reference_leaves_the_file_as_it_was(scene: bpy.types.Scene) -> None:
    make_eventful(scene)
    before = state_of_file()
    render_geometry(scene, bpy.context.view_layer, WIDTH, HEIGHT, {"floor": 1}, {1})
    assert differences(before, state_of_file()) == {}


def test_settings_come_back_after_a_failure(scene: bpy.types.Scene) -> None:
    make_eventful(scene)
    scene.camera = None
    before = state_of_file()
    with pytest.raises(RuntimeError):
        render_geometry(scene, bpy.context.view_layer, WIDTH, HEIGHT, {"floor": 1}, {1})
    assert differences(before, state_of_file()) == {}


def test_film_and_depth_come_back_from_every_format(scene: bpy.types.Scene) -> None:
    settings = scene.render.image_settings
    for media_type, file_format, depth, mode in (
        ("IMAGE", "JPEG", "8", "BW"),
        ("IMAGE", "TIFF", "16", "RGB"),
        ("IMAGE", "OPEN_EXR", "16", "RGB"),
        ("MULTI_LAYER_IMAGE", "OPEN_EXR_MULTILAYER", "16", "RGBA"),
        ("VIDEO", "FFMPEG", "8", "RGB"),
    ):
        settings.media_type, settings.file_format = media_type, file_format
        settings.color_depth, settings.color_mode = depth, mode
        before = state_of_file()
        render_reference(scene, bpy.context.view_layer, 4, 4, 1)
        assert differences(before, state_of_file()) == {}, file_format


@pytest.mark.parametrize("peer", ["eevee", "cycles1", "cycles8"])
def test_peers_agree_on_a_plain_floor(scene: bpy.types.Scene, peer: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # A sample of EEVEE's takes a second on a software renderer, however small the picture.
    monkeypatch.setattr(cycles_reference, "EEVEE_SAMPLES", 1)
    before = state_of_file()
    still = render_peer(scene, bpy.context.view_layer, peer, WIDTH, HEIGHT)
    assert differences(before, state_of_file()) == {}
    expected = np.array([0.5, 0.4, 0.3]) * 2.0 / np.pi
    assert still.pixels[..., :3].mean(axis=(0, 1)) == pytest.approx(expected, rel=0.05)


@pytest.mark.parametrize(
    ("peer", "engine", "samples"),
    [
        ("eevee", "BLENDER_EEVEE", [1, 16]),
        ("cycles1", "CYCLES", [1, 1]),
        ("cycles8", "CYCLES", [1, 8]),
        ("cycles64", "CYCLES", [1, 64]),
    ],
)
def test_the_second_render_is_the_one_that_counts(
    scene: bpy.types.Scene, monkeypatch: pytest.MonkeyPatch, peer: str, engine: str, samples: list[int]
) -> None:
    used: list[int] = []

    def record(scene: bpy.types.Scene, _view_layer: bpy.types.ViewLayer) -> Still:
        assert scene.render.engine == engine
        assert peer != "eevee" or scene.eevee.use_raytracing
        used.append(scene.eevee.taa_render_samples if peer == "eevee" else scene.cycles.samples)
        return Still(np.zeros((1, 1, 4), np.float32), float(len(used)))

    monkeypatch.setattr(cycles_reference, "render_still", record)
    assert render_peer(scene, bpy.context.view_layer, peer, WIDTH, HEIGHT).seconds == 2.0
    assert used == samples


def test_peers_are_timed_again_and_draw_other_samples_than_the_reference(
    scene: bpy.types.Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene.cycles.seed = 5
    seeds: list[int] = []

    def record(scene: bpy.types.Scene, _view_layer: bpy.types.ViewLayer) -> Still:
        seeds.append(scene.cycles.seed)
        return Still(np.zeros((1, 1, 4), np.float32), float(len(seeds)))

    monkeypatch.setattr(cycles_reference, "render_still", record)
    still = render_peer(scene, bpy.context.view_layer, "cycles8", WIDTH, HEIGHT, repeats=3, seconds=60.0)
    assert still.timing.times == (2000.0, 3000.0, 4000.0)
    assert still.seconds == 3.0
    assert seeds == [6] * 4 and scene.cycles.seed == 5
    render_reference(scene, bpy.context.view_layer, WIDTH, HEIGHT, 8)
    assert seeds[-1] == 5


def test_unknown_peer_is_named(scene: bpy.types.Scene) -> None:
    with pytest.raises(InputError, match="eevee, cycles1, cycles2"):
        render_peer(scene, bpy.context.view_layer, "cycles3", WIDTH, HEIGHT)


def test_temporary_settings_keep_the_first_value(scene: bpy.types.Scene) -> None:
    with temporary_settings() as changes:
        changes.set(scene.render, resolution_x=11)
        changes.set(scene.render, resolution_x=22)
        assert scene.render.resolution_x == 22
    assert scene.render.resolution_x == 1920


def test_exr_is_exact(tmp_path: Path) -> None:
    array = np.random.default_rng(3).normal(scale=1e3, size=(5, 7, 4)).astype(np.float32)
    array[0, 0] = (np.inf, -1e-30, 0.0, 0.0)
    images = len(bpy.data.images)
    save_exr(tmp_path / "a.exr", array)
    assert np.array_equal(load_exr(tmp_path / "a.exr"), array)
    assert len(bpy.data.images) <= images + 2, "only Blender's own Render Result and Viewer Node may appear"


def test_png_holds_the_bytes_of_the_standard_view(tmp_path: Path) -> None:
    linear = np.zeros((2, 3, 4), np.float32)
    linear[..., 3] = 1.0
    linear[0] = (0.18, 0.0, 7.0, 1.0)  # the bottom row
    linear[1, 1] = (0.09, 0.09, 0.09, 0.5)  # premultiplied
    save_png(tmp_path / "a.png", linear)
    image = bpy.data.images.load(str(tmp_path / "a.png"))
    stored = np.rint(np.array(image.pixels[:]).reshape(2, 3, 4) * 255).astype(int)
    assert stored[0].tolist() == [[118, 0, 255, 255]] * 3
    assert stored[1].tolist() == [[0, 0, 0, 255], [118, 118, 118, 128], [0, 0, 0, 255]]


def test_unreadable_exr(tmp_path: Path) -> None:
    (tmp_path / "a.exr").write_text("not an image")
    for name in ("a.exr", "missing.exr"):
        with pytest.raises(OSError, match=name):
            load_exr(tmp_path / name)
