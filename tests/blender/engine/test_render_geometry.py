# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is read of a scene to render it is what Cycles renders, also where the viewport shows something else."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_scene, with_render_depsgraph
from extraction import (
    CUBE_CORNERS,
    add,
    add_square,
    cycles_picture,
    empty_scene,
    extracted,
    instances_of,
    link,
    look_down,
    mesh_of,
)

SIZE = 48
WIDTH = 8.0


@pytest.fixture(autouse=True)
def _scene(gpu: None) -> None:
    empty_scene()
    look_down(WIDTH)


def subdivided() -> None:
    modifier = add("subdivided").modifiers.new("subdivision", "SUBSURF")
    modifier.levels, modifier.render_levels = 0, 4


def multiresolution() -> None:
    obj = add("sculpted")
    bpy.context.view_layer.objects.active = obj
    modifier = obj.modifiers.new("multires", "MULTIRES")
    for _ in range(3):
        bpy.ops.object.multires_subdivide(modifier=modifier.name)
    modifier.levels, modifier.render_levels = 0, 3


def simplified() -> None:
    subdivided()
    render = bpy.context.scene.render
    render.use_simplify = True
    render.simplify_subdivision, render.simplify_subdivision_render = 6, 0


def modifiers_of_one_only() -> None:
    obj = add("modified")
    for shown, name in ((True, "render"), (False, "viewport")):
        array = obj.modifiers.new(name, "ARRAY")
        array.relative_offset_displace = (0.0, 1.5 if shown else -1.5, 0.0)
        array.show_render, array.show_viewport = shown, not shown


def hidden_objects() -> None:
    for index, (switch, place) in enumerate((("hide_render", -2.5), ("hide_viewport", 2.5))):
        obj = add(f"{index}")
        obj.location.x = place
        setattr(obj, switch, True)
    add("closed eye").hide_set(True)


def hidden_collections() -> None:
    for place, switch in ((-2.5, "hide_render"), (2.5, "hide_viewport")):
        group = bpy.data.collections.new(switch)
        bpy.context.scene.collection.children.link(group)
        add(switch, collection=group).location.x = place
        setattr(group, switch, True)
    add("excluded", collection=_excluded())


def _excluded() -> bpy.types.Collection:
    group = bpy.data.collections.new("excluded")
    bpy.context.scene.collection.children.link(group)
    bpy.context.view_layer.layer_collection.children["excluded"].exclude = True
    return group


def _instancer(group: bpy.types.Collection, place: float) -> bpy.types.Object:
    empty = link(bpy.data.objects.new("place", None))
    empty.instance_type, empty.instance_collection = "COLLECTION", group
    empty.location.x = place
    return empty


def instanced_collections() -> None:
    shown, hidden = bpy.data.collections.new("shown"), bpy.data.collections.new("hidden")
    hidden.hide_render = True
    add("part", collection=shown)
    above = add("part of no render", collection=shown)
    above.location.y, above.hide_render = 2.5, True
    add("hidden part", collection=hidden)
    inner = bpy.data.collections.new("inner")
    shown.children.link(inner)
    inner.hide_render = True
    add("inner part", collection=inner).location.y = -2.5
    _instancer(shown, -2.5)
    _instancer(hidden, 2.5)


def _seed() -> bpy.types.Object:
    seed = add("seed", [(0.4 * x, 0.4 * y, 0.4 * z) for x, y, z in CUBE_CORNERS])
    seed.hide_render = seed.hide_viewport = True
    return seed


def hidden_seed_of_nodes() -> None:
    tree = bpy.data.node_groups.new("scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    scatter, info = tree.nodes.new("GeometryNodeInstanceOnPoints"), tree.nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = _seed()
    info.inputs["As Instance"].default_value = True
    tree.links.new(start.outputs[0], scatter.inputs["Points"])
    tree.links.new(info.outputs["Geometry"], scatter.inputs["Instance"])
    tree.links.new(scatter.outputs["Instances"], end.inputs[0])
    add_square("ground", 4.0).modifiers.new("scatter", "NODES").node_group = tree


def hidden_seed_of_particles() -> None:
    ground = add_square("ground", 5.0)
    ground.modifiers.new("particles", "PARTICLE_SYSTEM")
    settings = ground.particle_systems[0].settings
    settings.type, settings.count = "HAIR", 12
    settings.render_type, settings.instance_object = "OBJECT", _seed()
    settings.particle_size = 0.3
    ground.show_instancer_for_render = False


def instances_on_vertices() -> None:
    ground = add_square("ground", 4.0)
    ground.instance_type = "VERTS"
    _seed().hide_render = False
    bpy.data.objects["seed"].parent = ground


def curves_and_metaballs() -> None:
    curve = bpy.data.curves.new("curve", "CURVE")
    curve.dimensions, curve.fill_mode = "2D", "BOTH"
    curve.resolution_u, curve.render_resolution_u = 1, 12
    spline = curve.splines.new("BEZIER")
    spline.bezier_points.add(2)
    spline.use_cyclic_u = True
    for point, place in zip(spline.bezier_points, ((-3, 0, 0), (-1, 2, 0), (-1, -2, 0)), strict=True):
        point.co = place
        point.handle_left_type = point.handle_right_type = "AUTO"
    link(bpy.data.objects.new("curve", curve))
    ball = bpy.data.metaballs.new("ball")
    ball.resolution, ball.render_resolution = 1.0, 0.1
    ball.elements.new().radius = 1.5
    link(bpy.data.objects.new("ball", ball)).location.x = 2.0


KINDS = (
    subdivided,
    multiresolution,
    simplified,
    modifiers_of_one_only,
    hidden_objects,
    hidden_collections,
    instanced_collections,
    hidden_seed_of_nodes,
    hidden_seed_of_particles,
    instances_on_vertices,
    curves_and_metaballs,
)


@pytest.mark.parametrize("build", KINDS, ids=lambda build: build.__name__)
def test_what_is_drawn_is_what_cycles_renders(build: Callable[[], None]) -> None:
    build()
    white = bpy.data.materials.new("white")
    emission = white.node_tree.nodes.new("ShaderNodeEmission")
    output = white.node_tree.nodes["Material Output"]
    white.node_tree.links.new(emission.outputs[0], output.inputs["Surface"])
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    view_layer.material_override = white
    ours = picture()
    cycles = cycles_picture(SIZE, SIZE, 4)[..., 0]
    covered = cycles > 0.9
    assert 0.01 < covered.mean() < 0.7, "the scene shows nothing that could differ"
    # (Silhouettes are sampled at other places.)
    wrong = (np.abs(ours - cycles) > 0.6).mean()
    assert wrong < 0.002, f"{wrong:.1%} of the pixels"
    in_viewport = bpy.context.evaluated_depsgraph_get()
    assert in_viewport.mode == "VIEWPORT" and scene.render.engine == "BLENDER_EEVEE"


def picture() -> np.ndarray:
    """(SIZE, SIZE) of the red channel."""
    arrays, scene = extracted(), bpy.context.scene
    renderer = Renderer(arrays, Settings(samples=4))
    try:
        return renderer.render(view_of_camera(scene, scene.camera, SIZE, SIZE)).color()[..., 0]
    finally:
        renderer.free()


def test_a_mirror_that_is_only_in_a_collection_is_one_in_every_instance() -> None:
    group = bpy.data.collections.new("library")
    add("mirror", collection=group)
    for place in (-2.5, 2.5):
        _instancer(group, place)
    arrays, _view = read_render_scene(bpy.context.scene, bpy.context.view_layer, ["mirror"], SIZE, SIZE)
    (number,) = arrays.reflectors
    assert [instance.object_id for instance in instances_of(arrays, "mirror")] == [number, number]
    renderer = Renderer(arrays)
    try:
        assert len(renderer.mirrors) == 2
    finally:
        renderer.free()


def test_adaptive_subdivision_is_said() -> None:
    diced = add("diced")
    modifier = diced.modifiers.new("subdivision", "SUBSURF")
    modifier.render_levels = 3
    assert not extracted(diced).warnings
    modifier.use_adaptive_subdivision = True
    arrays = extracted(diced)
    assert len(mesh_of(arrays, "diced").positions) == 386
    assert [warning for warning in arrays.warnings if "adaptive" in warning and '"diced"' in warning]


def test_nothing_is_left_of_a_reading() -> None:
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    add("cube")
    other = link(bpy.data.objects.new("other", bpy.data.cameras.new("other")))
    scene.timeline_markers.new("cut", frame=1).camera = other
    first = scene.camera = bpy.data.objects["camera"]
    before = _state(scene)
    seen: list[Any] = []
    with_render_depsgraph(scene, view_layer, lambda graph: seen.append(graph.scene.camera.name), camera=first)
    with_render_depsgraph(scene, view_layer, lambda graph: seen.append(graph.mode))
    assert seen == ["camera", "RENDER"]
    scene.camera = first
    with pytest.raises(InputError, match="by the reader"):
        with_render_depsgraph(scene, view_layer, _refuse)
    assert _state(scene) == before
    assert not hasattr(bpy.types, "CURVREFL_READER") and "Render Result" not in bpy.data.images


def _refuse(_depsgraph: bpy.types.Depsgraph) -> None:
    raise InputError("refused by the reader")


def _state(scene: bpy.types.Scene) -> list[Any]:
    render = scene.render
    return [
        scene.camera,
        [(marker.frame, marker.camera) for marker in scene.timeline_markers],
        {name: getattr(render, name) for name in ("engine", "resolution_x", "resolution_y", "resolution_percentage")},
        {name: getattr(render, name) for name in ("use_border", "use_compositing", "use_sequencer", "use_multiview")},
        [len(kind) for kind in (bpy.data.objects, bpy.data.cameras, bpy.data.images, bpy.data.scenes)],
    ]
