# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of a mirror that turn away are not drawn where that changes nothing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.geometry.scene_geometry import SceneGeometry
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MeshArrays, SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.mirror_room import Room
from scenes.star_meshes import welded
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
SETTINGS = Settings(samples=1)
AWAY = look_at(np.array([0.0, -4.5, 1.0]), np.zeros(3), 160, 120, np.radians(40))
INSIDE = look_at(np.array([0.0, -0.3, 0.1]), np.zeros(3), 64, 48, np.radians(60))


def room(change: Callable[[MeshArrays], MeshArrays] = lambda mesh: mesh, scale_x: float = 1.0) -> SceneArrays:
    """A mirror, the scene's first instance, in front of a floor."""
    made = Room()
    made.add_mirror(Ellipsoid(0.9, 0.6, 0.7), 48)
    made.add_rectangle((0.0, 0.0, -1.0), (6.0, 0.0, 0.0), (0.0, 6.0, 0.0))
    arrays = made.arrays()
    mirror: InstanceArrays = arrays.instances[0]
    assert mirror.object_id in arrays.reflectors
    matrix = mirror.matrix @ np.diag([scale_x, 1.0, 1.0, 1.0])
    meshes = tuple(change(welded(item)) if index == mirror.mesh else item for index, item in enumerate(arrays.meshes))
    return replace(arrays, meshes=meshes, instances=(replace(mirror, matrix=matrix), *arrays.instances[1:]))


def hidden(renderer: Renderer, view: View) -> str:
    return renderer.geometry.hidden_faces(renderer.geometry.of_instance(0)[0], view)


def without_one(mesh: MeshArrays) -> MeshArrays:
    return replace(mesh, triangles=mesh.triangles[1:], triangle_slot=mesh.triangle_slot[1:])


@pytest.mark.parametrize(("scale_x", "expected"), [(1.0, "BACK"), (-1.0, "FRONT")])
def test_same_surfaces(scale_x: float, expected: str) -> None:
    renderer = Renderer(room(scale_x=scale_x), SETTINGS)
    assert hidden(renderer, AWAY) == expected
    culled = renderer.render(AWAY).surfaces
    with patch.object(SceneGeometry, "hidden_faces", lambda *_: "NONE"):
        whole = renderer.render(AWAY).surfaces
    assert (culled["seen_color"][..., 3] > 0.5).mean() > 0.1
    for name, array in whole.items():
        assert np.array_equal(culled[name], array), name
    renderer.free()


def test_nothing_is_left_out_of_an_open_mirror_or_around_the_eye() -> None:
    closed = Renderer(room(), SETTINGS)
    assert hidden(closed, INSIDE) == "NONE"
    assert closed.geometry.hidden_faces(closed.geometry.of_instance(0)[0], AWAY) == "BACK"
    closed.free()
    opened = Renderer(room(without_one), SETTINGS)
    assert hidden(opened, AWAY) == "NONE"
    opened.free()


def test_scenery_is_drawn_whole() -> None:
    renderer = Renderer(room(), SETTINGS)
    own = renderer.geometry.of_instance(0)[0]
    others = [chunk for chunk in renderer.geometry.chunks if chunk is not own]
    assert others
    assert {renderer.geometry.hidden_faces(chunk, AWAY) for chunk in others} == {"NONE"}
    renderer.free()


@pytest.mark.parametrize("method", ["exact", "newton"])
def test_a_mirrored_camera_sees_the_picture_mirrored(method: str) -> None:
    """A camera with a negative scale swaps left and right, and fronts stay fronts."""
    renderer = Renderer(room(), replace(SETTINGS, method=method))
    mirrored = replace(AWAY, world_to_view=np.diag([-1.0, 1.0, 1.0, 1.0]) @ AWAY.world_to_view)
    assert mirrored.is_mirrored and not AWAY.is_mirrored
    plain, swapped = renderer.render(AWAY).color(), renderer.render(mirrored).color()[:, ::-1]
    assert plain.std() > 0.05
    # (At edges, and where the sky's shadows are looked up in other directions, a few pixels differ.)
    assert (np.abs(swapped - plain).max(-1) > 0.02).mean() < 0.03
    renderer.free()
