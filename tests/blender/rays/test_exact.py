# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The method `exact` against every ray cast at every triangle in float64, and against what is known by construction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.geometry.mesh_facts import MeshFactsCache
from curvrefl.curvrefl_addon.renderer.geometry.mesh_inside import holds_point, is_closed
from curvrefl.curvrefl_addon.renderer.geometry.vertex_uploads import VertexUploads
from curvrefl.curvrefl_addon.renderer.mirrors import mirror as mirror_module
from curvrefl.curvrefl_addon.renderer.mirrors.mirror import Mirror
from curvrefl.curvrefl_addon.renderer.rays import mesh_trees
from curvrefl.curvrefl_addon.renderer.rays.ray_scene import RayScene
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import LightArrays, MaterialArrays, MeshArrays, WorldArrays
from scenes.exactness import judge
from scenes.mirror_halls import MIRRORS, hall
from scenes.mirror_room import Room
from scenes.paths.programs import Looked, painted, source_of, with_attributes
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

EYES = ((0.0, -5.0, 1.5), (3.0, 2.5, 4.0))


@pytest.mark.parametrize("mirror", MIRRORS)
@pytest.mark.parametrize("best", [False, True], ids=["quick", "best"])
def test_every_pixel_shows_what_its_ray_meets_first(mirror: str, best: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    if not best:
        # Or these small meshes would get the best tree at once.
        monkeypatch.setattr(mesh_trees, "FEW", 0)
    pixels = wrong = ties = 0
    for seed, eye in enumerate(EYES):
        scene = hall(mirror, seed)
        view = look_at(np.array(eye), np.zeros(3), 120, 90, 0.6)
        renderer = Renderer(scene, Settings(method="exact", samples=1))
        if best:
            renderer.rays().finish()
        verdict = judge(scene, view, renderer.render(view))
        renderer.free()
        pixels, wrong, ties = pixels + verdict.pixels, wrong + verdict.wrong, ties + verdict.ties
    assert pixels > 2000
    assert wrong == 0
    # Rays that pass within a millionth of a triangle's size of its edge may go either way.
    assert ties <= 1e-3 * pixels


def test_a_ball_over_a_floor_shows_what_closed_forms_say() -> None:
    room = Room()
    room.add_mirror(Ellipsoid(), 256)
    room.add_ball((0.0, -1.4, -0.2), 0.38)
    room.add_ball((1.5, -1.0, 0.4), 0.3)
    room.add_rectangle((0.0, 0.0, -1.0), (6.0, 0.0, 0.0), (0.0, 6.0, 0.0))
    view = look_at(np.array([0.0, -5.0, 1.0]), np.zeros(3), 160, 120, 0.5)
    on_ball, hit, shown = room.seen_in_ball(view)
    renderer = Renderer(room.arrays(), Settings(method="exact", samples=1))
    frame = renderer.render(view)
    both = on_ball & (frame.mask() > 0)
    assert (on_ball != (frame.mask() > 0)).sum() < 0.02 * on_ball.sum()
    same = frame.reflected_object() == hit
    # The mesh is not quite the ball: its facets' points are up to 8e-5 inside, and silhouettes of balls are polygons.
    assert (both & ~same).sum() < 0.005 * both.sum()
    on_points = both & same & (hit > 0)
    error = np.linalg.norm(frame.reflected_position()[..., :3] - shown, axis=-1)[on_points]
    assert np.median(error) < 1e-3
    renderer.free()


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_the_scale_of_a_scene_does_not_matter(scale: float) -> None:
    scene = hall("vase", 1, scale=scale)
    view = look_at(np.array(EYES[0]) * scale, np.zeros(3), 80, 60, 0.6, near=0.05 * scale, far=100.0 * scale)
    renderer = Renderer(scene, Settings(method="exact", samples=1))
    verdict = judge(scene, view, renderer.render(view))
    renderer.free()
    assert verdict.pixels > 500
    assert verdict.wrong == 0


def test_two_facing_mirrors_show_each_other_as_often_as_asked() -> None:
    """Between two flat mirrors at y = -1 and y = 1 the n-th image of a thing at distance d is known."""
    room = Room()
    room.add_rectangle((0.0, 1.0, 0.0), (4.0, 0.0, 0.0), (0.0, 0.0, 4.0))
    room.add_rectangle((0.0, -1.0, 0.0), (4.0, 0.0, 0.0), (0.0, 0.0, 4.0))
    room.add_rectangle((0.0, -0.5, -0.5), (0.02, 0.0, 0.0), (0.0, 0.0, 0.02))
    arrays = room.arrays()
    instances = [replace(item, materials=(1 if number < 2 else 2,)) for number, item in enumerate(arrays.instances)]
    lamp = MaterialArrays("lamp", base_color=(0.0, 0.0, 0.0), emission=(9.0, 9.0, 9.0))
    arrays = replace(
        arrays, instances=tuple(instances), materials=(*arrays.materials, lamp), world=WorldArrays(), reflectors=(1, 2)
    )
    view = look_at(np.array([0.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), 300, 300, 1.2)
    pictures = {}
    for bounces in (1, 2, 3):
        renderer = Renderer(arrays, Settings(method="exact", samples=1, bounces=bounces))
        frame = renderer.render(view)
        pictures[bounces] = frame.color()[..., :3]
        renderer.free()
    # The sheet is at (0, -0.5, -0.5). Its image by the mirror in front lies at y = 2.5, by both (the one behind, then
    # the one in front) at y = 3.5 and by three at y = 6.5: they are seen at z / y of the image below the middle.
    rows = {k: 150 + round(-0.5 / y / np.tan(0.6) * 150) for k, y in ((1, 2.5), (2, 3.5), (3, 6.5))}
    for bounces, picture in pictures.items():
        for image, row in rows.items():
            # As in Cycles what shines by itself is seen after one mirror more.
            assert (picture[row, 150].max() > 5.0) == (image <= bounces + 1), (bounces, image)


def test_an_eye_inside_a_closed_mirror_sees_its_inner_side() -> None:
    scene = hall("torus", 0)
    mesh = scene.meshes[0]
    assert is_closed(mesh)
    assert holds_point(mesh, np.array([0.9, 0.0, 0.0])) and not holds_point(mesh, np.zeros(3))
    view = look_at(np.array([0.9, 0.0, 0.0]), np.array([0.9, 1.0, 0.1]), 60, 45, 1.0, near=0.001)
    renderer = Renderer(scene, Settings(method="exact", samples=1))
    frame = renderer.render(view)
    assert (frame.mask() == 1).all()
    # Whatever is followed from there meets the inner side again.
    assert (frame.reflected_object() == 1).mean() > 0.98
    renderer.free()


def test_an_unbaked_mirror_is_asked_once_for_each_eye_and_place(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not for each sub-frame: all its triangles are looked at for that."""
    asked = []

    def counted(mesh: MeshArrays, point: np.ndarray) -> bool:
        asked.append(point)
        return holds_point(mesh, point)

    monkeypatch.setattr(mirror_module, "holds_point", counted)
    scene = hall("torus", 0)
    mirror = Mirror(scene, 0, 1, MeshFactsCache().of(scene.meshes[0]))
    shape = mirror.shape()
    hole, tube = np.zeros(3), np.array([0.9, 0.0, 0.0])
    views = [look_at(eye, eye + np.array([0.0, 1.0, 0.1]), 60, 45, 1.0) for eye in (hole, tube)]
    for number in range(50):
        assert [mirror.holds_eye(view.jittered(0.01 * number, 0.0), shape) for view in views] == [False, True]
    assert len(asked) == 2, "two viewports that draw in turn do not make each other forget"

    moved = scene.instances[0].matrix.copy()
    moved[:3, 3] += (0.9, 0.0, 0.05)
    instances = (replace(scene.instances[0], matrix=moved), *scene.instances[1:])
    assert mirror.follow(replace(scene, instances=instances), 0, 1)
    for _ in range(5):
        assert [mirror.holds_eye(view, shape) for view in views] == [True, False]
    assert len(asked) == 4, "elsewhere it is asked again"

    for number in range(100):
        mirror.holds_eye(look_at(tube + np.array([0.0, 0.001 * number, 0.0]), hole, 60, 45, 1.0), shape)
    before = len(asked)
    mirror.holds_eye(views[0], shape)
    assert len(asked) == before + 1, "the answers of a long flight are not all kept"


def same(one: Frame, other: Frame) -> bool:
    names = ("seen_position", "reflected_position")
    return all(
        np.array_equal(one.surfaces[name][one.mask() > 0], other.surfaces[name][other.mask() > 0]) for name in names
    )


def test_following_a_scene_ends_in_the_picture_of_a_fresh_renderer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Things move, deform, go and come back; fitted and improved trees show the same as those just built."""
    # Or these small meshes would get the best tree at once.
    monkeypatch.setattr(mesh_trees, "FEW", 0)
    view = look_at(np.array(EYES[0]), np.zeros(3), 120, 90, 0.6)
    scene = hall("vase", 0, clutter=8)
    renderer = Renderer(scene, Settings(method="exact", samples=1))
    first = renderer.render(view)
    again = renderer.render(view)
    assert np.array_equal(first.color(), again.color())
    assert same(again, first)

    shifted = scene.instances[3].matrix.copy()
    shifted[:3, 3] += (0.3, -0.2, 0.1)
    moved = replace(
        scene, instances=(*scene.instances[:3], replace(scene.instances[3], matrix=shifted), *scene.instances[4:])
    )
    ball = moved.meshes[1]
    bent = replace(ball, positions=(ball.positions * np.array([1.0, 0.7, 1.2], np.float32)), signature=1)
    deformed = replace(moved, meshes=(moved.meshes[0], bent, *moved.meshes[2:]))
    fewer = replace(deformed, instances=deformed.instances[:6])
    for state in (moved, deformed, fewer, deformed, scene):
        renderer.update(state)
        fresh = Renderer(state, Settings(method="exact", samples=1))
        expected = fresh.render(view)
        assert same(renderer.render(view), expected)
        fresh.free()
    assert renderer.hierarchies.counters["hierarchies fitted"] >= 1
    renderer.hierarchies.finish()
    assert renderer.hierarchies.counters["hierarchies improved"] >= 1
    assert same(renderer.render(view), first)
    renderer.free()


def test_a_tree_that_comes_apart_slowly_is_built_anew() -> None:
    """A step by itself leaves a tree that is nearly as good as the one before."""
    scene = hall("sphere", 0, clutter=1)
    ball = scene.meshes[1]
    shuffled = ball.positions[np.random.default_rng(0).permutation(len(ball.positions))]
    rays = RayScene(MeshFactsCache(), VertexUploads())
    rays.follow(scene, {0: 1})
    built = rays.counters["hierarchies built"]
    for share in np.linspace(0.0, 1.0, 60, dtype=np.float32)[1:]:
        bent = replace(ball, positions=(1.0 - share) * ball.positions + share * shuffled)
        rays.follow(replace(scene, meshes=(scene.meshes[0], bent, *scene.meshes[2:])), {0: 1})
    assert 1 <= rays.counters["hierarchies built"] - built < 20
    assert rays.counters["hierarchies fitted"] > 30


def test_what_is_hit_has_its_image_its_vertex_colors_and_its_second_material() -> None:
    room = Room()
    room.add_mirror(Ellipsoid(), 128)
    room.add_rectangle((0.0, -3.0, 0.0), (4.0, 0.0, 0.0), (0.0, 0.0, 4.0))
    arrays = room.arrays()
    sheet = arrays.meshes[1]
    uv = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], np.float32)
    vertex_colors = np.tile(np.array([1.0, 0.25, 1.0, 1.0], np.float32), (4, 1))
    sheet = with_attributes(sheet, uv=uv, colors=vertex_colors)
    sheet = replace(sheet, triangle_slot=np.array([0, 1], np.int32))
    pixels = np.zeros((2, 2, 4), np.float32)
    pixels[:, 0], pixels[:, 1] = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0)
    materials = (
        *arrays.materials,
        painted(MaterialArrays("image", base_color=(1.0, 1.0, 1.0)), Looked(is_nearest=True), with_colors=True),
        MaterialArrays("plain", base_color=(0.0, 0.0, 1.0)),
    )
    instances = (arrays.instances[0], replace(arrays.instances[1], materials=(2, 3)))
    arrays = replace(
        arrays,
        meshes=(arrays.meshes[0], sheet),
        instances=instances,
        materials=materials,
        images=(source_of("halves", pixels),),
    )
    view = look_at(np.array([0.0, -2.9, 0.0]), np.zeros(3), 120, 90, 0.5)
    renderer = Renderer(arrays, Settings(method="exact", samples=1))
    frame = renderer.render(view)
    path = renderer._targets.of(view.width, view.height).path(0)
    base = read_texture(path.color)[..., :3]
    hits = (frame.mask() > 0) & (frame.reflected_object() == 2)
    place = frame.reflected_position()[..., :3]
    across, up = (place[..., 0] + 4.0) / 8.0, (place[..., 2] + 4.0) / 8.0
    for half, color in ((across < 0.49, (1.0, 0.0, 0.0)), (across > 0.51, (0.0, 0.25, 0.0))):
        first = hits & (up < across - 0.01) & half
        assert first.sum() > 50
        assert np.abs(base[first] - color).max() < 2e-3
    second = hits & (up > across + 0.01)
    assert second.sum() > 50
    assert np.abs(base[second] - (0.0, 0.0, 1.0)).max() < 2e-3
    renderer.free()


def test_rays_shadow_what_is_hit() -> None:
    """A sun from above, a sheet over a floor: the floor is dark under the sheet, and lit beside it."""
    room = Room()
    room.add_mirror(Ellipsoid(), 128)
    room.add_rectangle((0.0, 0.0, -1.2), (8.0, 0.0, 0.0), (0.0, 8.0, 0.0))
    room.add_rectangle((0.0, -2.5, 1.6), (0.7, 0.0, 0.0), (0.0, 0.7, 0.0), visible_glossy=False)
    sun = LightArrays("sun", "SUN", (3.0, 3.0, 3.0), np.eye(4))
    arrays = replace(room.arrays(), lights=(sun,), world=WorldArrays())
    view = look_at(np.array([0.0, -5.5, 0.6]), np.zeros(3), 160, 120, 0.6)
    frame = Renderer(arrays, Settings(method="exact", samples=1, shadow_rays=True)).render(view)
    place, color = frame.reflected_position()[..., :3], frame.color()[..., 0]
    on_floor = (frame.mask() > 0) & (frame.reflected_object() == 2)
    off = np.maximum(np.abs(place[..., 0]), np.abs(place[..., 1] + 2.5)) - 0.7
    # The mirror itself stands between the sun and the floor below it.
    beside_mirror = np.linalg.norm(place[..., :2], axis=-1) > 1.1
    dark, lit = on_floor & (off < -0.02), on_floor & (off > 0.02) & beside_mirror
    assert dark.sum() > 30 and lit.sum() > 300
    assert color[dark].max() == 0.0
    assert color[lit].min() > 0.3


def test_what_has_moved_is_seen_where_it_is_now() -> None:
    """A state of the scene in which only matrices differ; then one in which more does."""
    scene = hall("vase", 2)
    view = look_at(np.array(EYES[0]), np.zeros(3), 80, 60, 0.6)
    renderer = Renderer(scene, Settings(method="exact", samples=1))
    renderer.render(view)
    before = dict(renderer.hierarchies.counters)
    turned = list(scene.instances)
    for index in (0, 2, 5, 9):
        matrix = turned[index].matrix.copy()
        # One is turned inside out, too.
        matrix[:3, 0] *= -1.0 if index == 5 else 1.0
        matrix[:3, 3] += (0.1, -0.3, 0.2)
        turned[index] = replace(turned[index], matrix=matrix)
    moved = replace(scene, instances=tuple(turned))
    renderer.update(moved)
    verdict = judge(moved, view, renderer.render(view))
    assert verdict.pixels > 500 and verdict.wrong == 0
    assert renderer.hierarchies.counters["hierarchies built"] == before["hierarchies built"]
    hidden = replace(turned[2], visible_glossy=False, matrix=scene.instances[2].matrix)
    rest = replace(moved, instances=(*turned[:2], hidden, *turned[3:]))
    renderer.update(rest)
    shown = renderer.render(view).reflected_object()
    assert not (shown == hidden.object_id).any()
    renderer.free()
