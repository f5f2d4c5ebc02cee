# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What no map of directions can hold, and what is no mesh at all, is refused in a sentence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.mirrors.reflector_bake import Limits, bake_reflector
from curvrefl.curvrefl_addon.scene.arrays import MeshArrays
from mirrors.star_baking import ANYTHING, ORIGIN, affine, bake, bowl, capped_ball, two_balls
from scenes.star_meshes import mesh_of, moved, only, scene_of, star_mesh, torus

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (capped_ball, ("not star-shaped", "%", "split")),
        (lambda: torus(1.0, 0.4), ("not star-shaped", "%", "split")),
        (lambda: torus(1.0, 0.95), ("not star-shaped", "%", "split")),
        (two_balls, ("not star-shaped", "%", "split")),
        (bowl, ("open", "%", "fill its holes")),
        (lambda: only(star_mesh(Ellipsoid(), 32), np.arange(1)), ("flat", "closed")),
    ],
    ids=["capped ball", "torus", "fat torus", "two balls", "bowl", "one triangle"],
)
def test_what_no_map_can_hold_is_refused(make: object, words: tuple[str, ...]) -> None:
    with pytest.raises(InputError) as caught:
        bake(make())  # type: ignore[operator]
    message = str(caught.value)
    assert '"Ball"' in message and "\n" not in message
    assert all(word in message for word in words)


def test_limits_are_the_caller_s() -> None:
    for mesh in (torus(1.0, 0.4), two_balls(), bowl()):
        baked = bake(mesh, 32, limits=ANYTHING)
        assert np.isfinite(baked.radial).all() and baked.r_min > 0.0
    with pytest.raises(InputError, match="open"):
        ball = star_mesh(Ellipsoid(), 32)
        bake(only(ball, np.arange(len(ball.triangles)) != 7), limits=Limits(0.0, 0.0))


def spoilt_position(value: float) -> MeshArrays:
    mesh = star_mesh(Ellipsoid(), 8)
    mesh.positions[5, 1] = value
    return mesh


def spoilt_normal() -> MeshArrays:
    mesh = star_mesh(Ellipsoid(), 8)
    mesh.corner_normals[3] = np.nan
    return mesh


def flat() -> MeshArrays:
    points = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)])
    return mesh_of(points, np.tile([0.0, 0.0, 1.0], (4, 1)), np.array([[0, 1, 2], [0, 2, 3]]))


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        (replace(star_mesh(Ellipsoid(), 8), triangles=np.zeros((0, 3), np.int32)), "no faces"),
        (spoilt_position(np.nan), "finite"),
        (spoilt_position(np.inf), "finite"),
        (spoilt_normal(), "finite"),
        (moved(star_mesh(Ellipsoid(), 8), (1.0, 2.0, 3.0), 0.0), "single point"),
        (flat(), "flat"),
    ],
    ids=["empty", "nan", "infinite", "nan normal", "point", "flat"],
)
def test_broken_meshes_are_refused(mesh: MeshArrays, words: str) -> None:
    with pytest.raises(InputError, match=words):
        bake(mesh)


@pytest.mark.parametrize(
    ("matrix", "words"),
    [
        (np.diag([1.0, 1.0, 0.0, 1.0]), "scale"),
        (np.diag([0.0, 0.0, 0.0, 1.0]), "scale"),
        (affine(np.diag([1.0, np.nan, 1.0]), ORIGIN), "finite"),
        (affine(np.eye(3), (np.inf, 0.0, 0.0)), "finite"),
    ],
)
def test_broken_transforms_are_refused(matrix: np.ndarray, words: str) -> None:
    with pytest.raises(InputError, match=words):
        bake_reflector(scene_of(star_mesh(Ellipsoid(), 8), matrix), 1)


@pytest.mark.parametrize("resolution", [0, 7, 4096, -1])
def test_resolutions_out_of_range_are_refused(resolution: int) -> None:
    with pytest.raises(InputError, match="out of range"):
        bake(star_mesh(Ellipsoid(), 8), resolution)


@pytest.mark.parametrize("center", [(0.0, 0.0), (np.nan, 0.0, 0.0)])
def test_bad_centers_are_refused(center: tuple[float, ...]) -> None:
    with pytest.raises(InputError, match="three finite numbers"):
        bake(star_mesh(Ellipsoid(), 8), center=center)


def test_a_center_outside_is_refused() -> None:
    with pytest.raises(InputError, match="star-shaped"):
        bake(star_mesh(Ellipsoid(), 16), center=(5.0, 0.0, 0.0))
