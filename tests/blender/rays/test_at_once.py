# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays that go on from mirror to mirror in one pass show what a pass for each mirror does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.rays.paths import PathBuffer
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.shown import rays as shown_rays
from curvrefl.curvrefl_addon.scene.arrays import LightArrays, SceneArrays
from curvrefl.curvrefl_addon.scene.programs.program import Program, Shape
from scenes.mirror_halls import hall
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

BY_DEPTH = """void material_program(ShadingPoint s, inout Material m)
{
  m.base_color = vec3(0.2 * s.depths.x, 0.1 * min(s.ray_length, 9.0), 0.5 + 0.5 * s.incoming.z);
}
"""
"""Of what a program is told about the ray"""
HALF_STEP = 1.0 / 1024.0
"""Of half precision, in which passes hand on what mirrors leave of the light"""


def scene_of(mirror: str, mirrors: int = 1) -> SceneArrays:
    """A hall under a sun, whose things tell how rays have got to them."""
    scene = hall(mirror, mirrors=mirrors)
    program = Program(Shape(BY_DEPTH, (), 0, ("base_color",), frozenset()), np.zeros((0, 4), np.float32), (), ())
    matt = replace(scene.materials[0], program=program)
    sun = LightArrays("sun", "SUN", (2.0, 2.0, 2.0), np.eye(4))
    gold = replace(scene.materials[1], base_color=(0.9, 0.7, 0.3))
    return replace(scene, materials=(matt, gold), lights=(sun,))


def pictures(scene: SceneArrays, monkeypatch: pytest.MonkeyPatch, bounces: int) -> tuple[np.ndarray, np.ndarray, int]:
    """By passes and at once, and the greatest number of surfaces that rays were followed to in one pass."""
    view = look_at(np.array((0.6, -3.0, 3.4)), np.array((0.6, 0.0, 0.0)), 160, 120, 0.7)
    follow, most = PathBuffer.follow, []

    def counted(*arguments: object, most_hits: int = 1, **named: object) -> None:
        most.append(most_hits)
        follow(*arguments, most_hits=most_hits, **named)  # type: ignore[arg-type]

    found = []
    for is_allowed in (False, True):
        with monkeypatch.context() as change:
            change.setattr(PathBuffer, "follow", counted)
            if not is_allowed:
                change.setattr(shown_rays, "_go_on_at_once", lambda *_: False)
            renderer = Renderer(scene, Settings(method="exact", samples=1, bounces=bounces))
            found.append(renderer.render(view).color())
            renderer.free()
    return found[0], found[1], max(most)


def test_lamps_that_no_ray_meets_between_mirrors_are_seen_at_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_of("bowl")
    above = np.eye(4)
    above[:3, 3] = (0.3, 0.2, 2.4)
    for lamp in (
        LightArrays("ball", "POINT", (90.0, 90.0, 90.0), above, radius=0.9),
        LightArrays("area", "AREA", (90.0, 90.0, 90.0), above, size=(2.0, 1.5)),
    ):
        by_passes, at_once, most = pictures(replace(scene, lights=(lamp,)), monkeypatch, bounces=2)
        assert most == 3
        unlit, _, _ = pictures(replace(scene, lights=(replace(lamp, visible_glossy=False),)), monkeypatch, bounces=2)
        assert (np.abs(by_passes - unlit).max(axis=-1) > 1.0).sum() > 50, "mirrors show the lamp"
        difference = np.abs(at_once - by_passes).max(axis=-1)
        assert (difference <= 2.0 * HALF_STEP * np.maximum(by_passes.max(axis=-1), 1e-3)).all()


@pytest.mark.parametrize("bounces", [1, 2, 4])
@pytest.mark.parametrize(("mirror", "mirrors"), [("bowl", 1), ("torus", 1), ("sphere", 2)])
def test_both_ways_show_the_same(mirror: str, mirrors: int, bounces: int, monkeypatch: pytest.MonkeyPatch) -> None:
    by_passes, at_once, most = pictures(scene_of(mirror, mirrors), monkeypatch, bounces=bounces)
    assert most == bounces + 1
    difference = np.abs(at_once - by_passes).max(axis=-1)
    assert (difference > 0.0).sum() > 20, "there are mirrors in mirrors, with tints that are rounded less often"
    assert (difference <= bounces * HALF_STEP * np.maximum(by_passes.max(axis=-1), 1e-3)).all()


def test_where_mirrors_show_more_than_they_reflect_each_has_its_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_of("bowl")
    gold = scene.materials[1]
    inside = np.eye(4)
    inside[2, 3] = -0.3
    lamp = LightArrays("lamp", "POINT", (90.0, 90.0, 90.0), inside, radius=0.1)
    others = {
        "shines": replace(scene, materials=(scene.materials[0], replace(gold, emission=(0.1, 0.0, 0.0)))),
        "has a program": replace(
            scene, materials=(scene.materials[0], replace(gold, program=scene.materials[0].program))
        ),
        "holds a lamp": replace(scene, lights=(lamp,)),
    }
    for name, other in others.items():
        by_passes, at_once, most = pictures(other, monkeypatch, bounces=2)
        assert most == 1, name
        assert np.array_equal(by_passes, at_once), name
