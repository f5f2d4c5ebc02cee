# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The method `auto`: what it chooses and why, and that the error asked for holds, against Newton in float64."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.solvers.descent import minimize
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, RadialSurface, unit
from curvrefl.curvrefl_addon.renderer import choice as choices
from curvrefl.curvrefl_addon.renderer import preparation
from curvrefl.curvrefl_addon.renderer.choice import RAYS, VERTICES
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.geometry import scene_geometry
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes import mirror_halls
from scenes.mirror_halls import hall
from scenes.star_meshes import star_mesh
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
EYE = np.array([0.0, -5.0, 1.5])
SURFACES = {"sphere": Ellipsoid(), "ellipsoid": Ellipsoid(1.2, 0.6, 0.4)}


def fine_hall(name: str, monkeypatch: pytest.MonkeyPatch) -> SceneArrays:
    """A hall whose mirror is as good as the smooth surface."""
    monkeypatch.setitem(mirror_halls.MIRRORS, name, lambda: star_mesh(SURFACES[name], 128))
    return hall(name, 0)


def rendered(scene: SceneArrays, view: View, **settings: object) -> Frame:
    return Renderer(scene, replace(Settings(method="auto", samples=1), **settings)).render(view)  # type: ignore[arg-type]


def pixel_errors(surface: RadialSurface, frame: Frame) -> np.ndarray:
    """(n,) how far from its pixel what is shown there is reflected in truth; a surface point for each such pixel."""
    shows = (frame.mask() > 0) & (frame.reflected_object() > 0)
    shown = frame.reflected_position()[shows][:, :3].astype(np.float64)
    start = unit(frame.reflector_position()[shows].astype(np.float64))
    screen = Screen(frame.view.eye, frame.view.focal_pixels)
    u, converged, _ = minimize(surface, screen, shown, start, 60, 1e-4)
    assert converged.mean() > 0.999
    radius, _ = surface.radius(u)
    row, column = np.nonzero(shows)
    centers = np.column_stack([column + 0.5, row + 0.5])
    return np.linalg.norm(frame.view.project(radius[:, None] * u) - centers, axis=1)[converged]


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("way", [RAYS, VERTICES])
@pytest.mark.parametrize("tolerance", [0.5, 2.0])
def test_the_error_asked_for_holds(name: str, way: str, tolerance: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whichever way is chosen: the choice is pushed to both sides."""
    monkeypatch.setattr(choices, "MOST_SHARE", 0.0 if way == RAYS else 1e9)
    frame = rendered(fine_hall(name, monkeypatch), look_at(EYE, np.zeros(3), 480, 360, 0.6), pixel_tolerance=tolerance)
    assert frame.choice is not None and frame.choice["method"] == way
    assert np.percentile(pixel_errors(SURFACES[name], frame), 99) < tolerance


def test_few_vertices_on_a_large_mirror_are_solved_and_many_on_a_small_one_are_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene = fine_hall("sphere", monkeypatch)
    few = replace(scene, instances=scene.instances[:2])
    large = rendered(few, look_at(EYE, np.zeros(3), 960, 720, 0.5), pixel_tolerance=8.0)
    small = rendered(scene, look_at(4.0 * EYE, np.zeros(3), 160, 120, 0.6))
    assert large.choice is not None and large.choice["method"] == VERTICES
    assert small.choice is not None and small.choice["method"] == RAYS
    assert "rays are followed" in str(small.choice["why"])


@pytest.mark.parametrize("name", ["torus", "vase", "bowl", "wave"])
def test_mirrors_that_show_a_point_several_times_follow_rays(name: str) -> None:
    frame = rendered(hall(name, 0), look_at(EYE, np.zeros(3), 160, 120, 0.6))
    assert frame.choice is not None and frame.choice["method"] == RAYS
    assert "several times" in str(frame.choice["why"])


def test_several_mirrors_follow_rays() -> None:
    frame = rendered(hall("sphere", 0, mirrors=2), look_at(EYE, np.zeros(3), 160, 120, 0.8))
    assert frame.choice is not None and "in each other" in str(frame.choice["why"])


def test_shadows_by_rays_follow_rays(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a mirror whose few vertices would be solved else: points have shadows out of depth maps alone."""
    monkeypatch.setattr(choices, "MOST_SHARE", 1e9)
    view = look_at(EYE, np.zeros(3), 160, 120, 0.6)
    frame = rendered(hall("sphere", 0), view, shadow_rays=True)
    assert frame.choice is not None and frame.choice["method"] == RAYS
    assert "Shadows by rays" in str(frame.choice["why"])


@pytest.mark.parametrize(
    ("of_mirror", "of_scenery", "why"),
    [
        ({}, {}, None),
        ({"roughness": 0.3}, {}, "is rough"),
        ({"metallic": 0.0, "transmission": 1.0}, {}, "is glass"),
        ({"coat_weight": 1.0, "coat_roughness": 0.0}, {}, "has a coat"),
        ({}, {"alpha": 0.5}, "may show what is seen through"),
        ({}, {"transmission": 1.0}, "may show what is seen through"),
        ({}, {"coat_weight": 1.0, "roughness": 0.1}, None),
    ],
    ids=str,
)
def test_what_only_rays_show_is_followed(
    of_mirror: dict[str, float], of_scenery: dict[str, float], why: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a mirror whose points would be solved else."""
    monkeypatch.setattr(choices, "MOST_SHARE", 1e9)
    scene = hall("sphere", 0)
    mirrors = {index for item in scene.instances if item.object_id in scene.reflectors for index in item.materials}
    materials = tuple(
        replace(material, **(of_mirror if index in mirrors else of_scenery))  # type: ignore[arg-type]
        for index, material in enumerate(scene.materials)
    )
    renderer = Renderer(replace(scene, materials=materials), Settings(method="auto", samples=1))
    choice = renderer.reflect(look_at(EYE, np.zeros(3), 160, 120, 0.6)).choice
    assert choice is not None and choice.methods == (VERTICES if why is None else RAYS,)
    assert why is None or why in choice.why
    renderer.free()


def test_what_lies_in_the_mirrors_shadow_is_not_reflected() -> None:
    """A ball straight behind the mirror is named as not reflected, and wins no pixel of the true picture."""
    scene = hall("sphere", 0, clutter=6)
    behind = np.diag([0.3, 0.3, 0.3, 1.0])
    behind[:3, 3] = -1.8 * unit(EYE[None])[0]
    number = len(scene.instances) + 1
    scene = replace(scene, instances=(*scene.instances, InstanceArrays("behind", number, 1, behind, (0,))))
    view = look_at(EYE, np.zeros(3), 240, 180, 0.6)
    frame = rendered(scene, view)
    assert frame.choice is not None
    objects = frame.choice["objects"]
    assert isinstance(objects, dict) and objects["not reflected"] == 1
    exact = rendered(scene, view, method="exact")
    assert not (exact.reflected_object() == number).any()


@pytest.mark.parametrize("method", ["newton", "secant_star"])
def test_chunks_in_the_mirrors_shadow_are_not_solved(method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The picture is the same to the last bit without them, and from the other side they are there."""
    monkeypatch.setattr(scene_geometry, "CHUNK_TRIANGLES", 1)
    scene = hall("sphere", 0, clutter=4)
    behind = np.diag([0.3, 0.3, 0.3, 1.0])
    behind[:3, 3] = -1.8 * unit(EYE[None])[0]
    number = len(scene.instances) + 1
    scene = replace(scene, instances=(*scene.instances, InstanceArrays("behind", number, 1, behind, (0,))))
    renderer = Renderer(scene, Settings(method=method, samples=1))
    view = look_at(EYE, np.zeros(3), 240, 180, 0.6)
    frame = renderer.render(view)
    solved, picture = frame.solve["vertices"], frame.color()
    from_behind = renderer.render(look_at(EYE * (1.0, -1.0, 1.0), np.zeros(3), 240, 180, 0.6))
    assert from_behind.solve["vertices"] > solved
    assert (from_behind.reflected_object() == number).any()
    with monkeypatch.context() as patched:
        patched.setattr(preparation, "in_shadow", lambda mirror, view, centers, radii: np.zeros(len(radii), bool))
        whole = renderer.render(view)
    assert whole.solve["vertices"] > solved
    np.testing.assert_array_equal(whole.color(), picture)
