# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Setting a film up and taking it away: what is added, what follows the scene, and that nothing is left of it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.film.film import film_of, set_up
from curvrefl.curvrefl_addon.film.follow import follow_films
from curvrefl.curvrefl_addon.film.layers import held_out_layer
from film.film_scene import BALL, build


@pytest.fixture(scope="module", autouse=True)
def _extension() -> Iterator[None]:
    registration.register()
    yield
    registration.unregister()


@pytest.fixture
def scene() -> Any:
    return build()


def composited(scene: Any) -> Any:
    """A compositor of the user's: the image, blurred, goes out, and to a viewer as it is."""
    tree: Any = bpy.data.node_groups.new("look", "CompositorNodeTree")
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    layers, blur = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeBlur")
    end, viewer = tree.nodes.new("NodeGroupOutput"), tree.nodes.new("CompositorNodeViewer")
    layers.scene, layers.layer = scene, scene.view_layers[0].name
    for target in (blur.inputs["Image"], viewer.inputs["Image"]):
        tree.links.new(layers.outputs["Image"], target)
    tree.links.new(blur.outputs["Image"], end.inputs[0])
    scene.compositing_node_group = tree
    return tree


def state(scene: Any) -> list[Any]:
    """All that a film touches. (Blender counts users of scenes anew when it opens a file.)"""
    tree = scene.compositing_node_group
    links = sorted(
        (link.from_node.name, link.from_socket.name, link.to_node.name, link.to_socket.identifier)
        for link in (tree.links if tree else ())
    )
    blocks = ("scenes", "collections", "node_groups", "objects", "cameras", "images", "worlds", "materials")
    return [
        {name: [(block.name, name == "scenes" or block.users) for block in getattr(bpy.data, name)] for name in blocks},
        links,
        sorted(node.name for node in (tree.nodes if tree else ())),
        [layer.name for layer in scene.view_layers],
        [[child.name, child.exclude, child.holdout] for child in scene.view_layers[0].layer_collection.children],
        [obj.name for obj in scene.objects],
        scene.render.use_compositing,
        scene.render.engine,
    ]


@pytest.mark.parametrize("has_compositor", [False, True], ids=["plain", "composited"])
def test_nothing_is_left_of_a_film(scene: Any, has_compositor: bool) -> None:
    if has_compositor:
        composited(scene)
    else:
        scene.render.use_compositing = False
    scene.collection.children.link(bpy.data.collections.new("things"))
    before = state(scene)
    for _again in range(2):
        assert bpy.ops.curvrefl.set_up_film(layers=True) == {"FINISHED"}
        assert state(scene) != before
    film = film_of(scene)
    assert film is not None and film.background_set == scene and film.render.engine == "CURVREFL"
    tree = scene.compositing_node_group
    (join,) = [node for node in tree.nodes if node.bl_idname == "CompositorNodeGroup"]
    targets = {link.to_node.bl_idname for link in join.outputs["Image"].links}
    whole = {"CompositorNodeBlur", "CompositorNodeViewer"} if has_compositor else {"NodeGroupOutput"}
    assert targets == whole | {"CompositorNodeOutputFile"}
    assert bpy.ops.curvrefl.remove_film() == {"FINISHED"}
    assert state(scene) == before
    assert not bpy.ops.curvrefl.remove_film.poll()


def test_a_film_follows_its_scene(scene: Any) -> None:
    group = bpy.data.collections.new("things")
    scene.collection.children.link(group)
    bpy.ops.curvrefl.set_up_film()
    film, double = film_of(scene), held_out_layer(scene)
    assert film is not None and double is not None
    mirrors = film.curvrefl.film_collection
    assert list(mirrors.objects) == [bpy.data.objects[BALL]]
    (held,) = [child for child in double.layer_collection.children if child.collection == mirrors]
    (left,) = [child for child in scene.view_layers[0].layer_collection.children if child.collection == mirrors]
    assert held.holdout and not held.exclude and left.exclude

    second = bpy.data.objects.new("second", bpy.data.objects[BALL].data)
    scene.collection.objects.link(second)
    bpy.context.view_layer.update()
    second.curvrefl.is_mirror = True
    assert set(mirrors.objects) == {bpy.data.objects[BALL], second}
    bpy.data.objects[BALL].curvrefl.is_mirror = False
    assert list(mirrors.objects) == [second]

    camera = bpy.data.objects.new("other", bpy.data.cameras.new("other"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.view_layers[0].layer_collection.children["things"].exclude = True
    scene.view_layers[0].use_sky = False
    scene.render.use_simplify = True
    bpy.context.view_layer.update()
    assert film.camera == camera and film.render.use_simplify
    assert double.layer_collection.children["things"].exclude and not double.use_sky
    assert not film.view_layers[0].use_sky
    scene.timeline_markers.new("cut", frame=5).camera = bpy.data.objects["Eye"]
    follow_films()
    assert [(marker.frame, marker.camera.name) for marker in film.timeline_markers] == [(5, "Eye")]


def test_a_film_is_undone_in_one_step(scene: Any) -> None:
    bpy.context.preferences.edit.use_global_undo = True
    before = state(scene)
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.curvrefl.set_up_film()
    bpy.ops.ed.undo_push(message="film")
    bpy.ops.ed.undo()
    assert state(bpy.context.scene) == before
    assert film_of(bpy.context.scene) is None


def test_what_mirrors_may_stay_behind_is_named(scene: Any) -> None:
    def put(name: str, *kinds: str) -> Any:
        material = bpy.data.materials.new(name)
        nodes: Any = material.node_tree.nodes
        mesh = bpy.data.objects[BALL].data.copy()
        mesh.materials.clear()
        mesh.materials.append(material)
        scene.collection.objects.link(bpy.data.objects.new(name, mesh))
        for kind in kinds:
            nodes.new(kind)
        return nodes

    put("wood")
    assert set_up(scene) == []
    put("pane", "ShaderNodeBsdfGlass")
    put("lace")["Principled BSDF"].inputs["Alpha"].default_value = 0.5
    group = bpy.data.node_groups.new("nested", "ShaderNodeTree")
    group.nodes.new("ShaderNodeBsdfTransparent")
    put("leaf", "ShaderNodeGroup")["Group"].node_tree = group
    (told,) = set_up(scene)
    assert told.startswith('Behind "') and all(f'"{name}"' in told for name in ("pane", "lace", "leaf"))
    assert "wood" not in told and BALL not in told
    scene.view_layers.new("another")
    assert any('"another" stay' in sentence for sentence in set_up(scene))


@pytest.mark.parametrize(
    ("problem", "named"),
    [
        ("cycles", "EEVEE"),
        ("mirror", "mirror"),
        ("camera", "camera"),
        ("stereo", "Stereo"),
        ("single", "Single Layer"),
        ("unused", "Render Layers"),
        ("film", "itself"),
    ],
)
def test_what_cannot_be_filmed_is_said_and_left_as_it_was(scene: Any, problem: str, named: str) -> None:
    if problem == "cycles":
        scene.render.engine = "CYCLES"
    elif problem == "mirror":
        bpy.data.objects[BALL].curvrefl.is_mirror = False
    elif problem == "camera":
        scene.camera = None
    elif problem == "stereo":
        scene.render.use_multiview = True
    elif problem == "single":
        scene.render.use_single_layer = True
    elif problem == "unused":
        composited(scene).nodes.remove(scene.compositing_node_group.nodes["Render Layers"])
    else:
        scene.curvrefl.film_source = bpy.data.scenes.new("filmed")
    before = state(scene)
    with pytest.raises(RuntimeError, match=named):
        bpy.ops.curvrefl.set_up_film()
    assert state(scene) == before


@pytest.mark.parametrize(
    ("arguments", "named"),
    [(("--frames", "5-1"), "last"), (("--frames", "x"), "1-24"), (("--output", "a.jpg"), ".png")],
)
def test_bad_usage_of_the_verb_is_a_sentence(
    arguments: tuple[str, ...], named: str, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    given = ["film", "x.blend", "--output", str(tmp_path / "a.png"), *arguments]
    assert cli.main(given) == 2
    assert named in capfd.readouterr().err
