# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirrors that bend both ways: regions, an image in each, and pictures against every pixel's own ray."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.fermat import sample
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.solvers import newton_region
from curvrefl.curvrefl_addon.optics.surfaces import curvature_regions
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface, texel_directions
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.renderer.device.cubes import cube_texture
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.vertices.mirror_solver import MirrorSolver
from curvrefl.curvrefl_addon.renderer.vertices.solution import VertexSolution
from curvrefl.curvrefl_addon.renderer.vertices.solve import Reflector, RegionTextures, solve_region, solve_vertices
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.study.solvers.regimes import make_cases
from curvrefl.curvrefl_addon.study.solvers.solver_table import study_view
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import STUDIES
from curvrefl.curvrefl_addon.study.stability.scenes import Trial, _box, _trial, trials

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.mark.parametrize("name", ["strongly bumpy", "kettle", "saddle"])
def test_images_in_regions_are_the_oracles(name: str) -> None:
    study = STUDIES[name]
    cases = make_cases(study, "near", 300)
    view = study_view(cases.eye)
    screen = Screen(cases.eye, view.focal_pixels)
    at = sample(study.surface, texel_directions(128).reshape(-1, 3))
    faces = np.column_stack([at.radius, at.gradient]).reshape(6, 128, 128, 4).astype(np.float32)
    surface = CubeMapSurface(faces)
    regions = curvature_regions.curvature_regions(surface)
    textures = RegionTextures(regions)
    records = np.zeros((len(cases.vertices), 4), np.float32)
    records[:, :3] = cases.vertices
    positions = record_texture(records)
    reflector = Reflector(np.eye(4), surface.bound, {"radial": cube_texture(faces)})
    truth = study.oracle().reflection_points(cases.eye, cases.vertices)

    def shown(solutions: list[VertexSolution]) -> float:
        """Share of all visible reflection points that have been found to half a pixel."""
        least = np.full(len(truth.vertex), np.inf)
        for solution in solutions:
            points, code, _, _ = solution.read()
            off = screen.pixels(truth.point, points[truth.vertex] - truth.point)
            error = np.where((code == status.REFLECTED)[truth.vertex], np.linalg.norm(off, axis=1), np.inf)
            least = np.minimum(least, error)
        return float((least[truth.visible] < 0.5).mean())

    first = solve_vertices("newton", view, reflector, positions, len(records))
    found = [first]
    for region in range(len(regions)):
        solution = solve_region(view, reflector, textures, region, positions, len(records))
        points, code, _, _ = solution.read()
        expected = newton_region.solve_region(surface, screen, cases.vertices, regions, region)
        assert (code == expected.status).mean() > 0.98
        both = (code == status.REFLECTED) & (expected.status == status.REFLECTED)
        off = screen.pixels(expected.at.position[both], (points - expected.at.position)[both])
        # Where the map's texels meet float32 may choose another zero of the same region.
        assert (np.linalg.norm(off, axis=1) > 0.1).sum() <= 0.02 * max(both.sum(), 50)
        nearest = truth.nearest_to(points.astype(np.float64))
        error = np.linalg.norm(screen.pixels(nearest, points - nearest), axis=1)
        # Where images merge the oracle may miss one of a pair.
        claimed = code == status.REFLECTED
        assert (~(error[claimed] < 0.5)).sum() <= 0.03 * len(records)
        found.append(solution)
    assert shown(found) > shown([first]) + 0.03
    assert shown(found) > 0.88


def crowded_trial(name: str) -> Trial:
    """Boxes all around the mirror, at two to five radii, most of them in front of it."""
    random = np.random.default_rng(3)
    eye = {"strongly bumpy": (2.6, -3.2, 1.6), "kettle": (2.6, -3.2, 1.2), "saddle": (0.6, -0.9, 3.6)}[name]
    boxes = []
    while len(boxes) < 60:
        direction = unit(random.normal(size=(1, 3)))[0]
        center = direction * random.uniform(2.0, 5.0)
        # Not before the eye.
        if direction @ unit(np.array([eye]))[0] < 0.9:
            x, y, z = center.tolist()
            boxes.append(_box((x, y, z), 0.09 * float(np.linalg.norm(center))))
    return _trial("crowd", "Boxes around a mirror that bends both ways.", name, eye, boxes)


def wrong_share(frame: Frame, scene: SceneArrays) -> tuple[float, float]:
    """Shares of mirror pixels whose own reflected ray meets another object than is shown; and something that is not."""
    mask = frame.mask() > 0
    point = frame.surfaces["seen_position"][mask][:, :3].astype(np.float64)
    normal = frame.surfaces["seen_normal"][mask][:, :3].astype(np.float64)
    to_eye = frame.view.eye[:3] - point
    to_eye /= np.linalg.norm(to_eye, axis=1, keepdims=True)
    ray = 2.0 * (normal * to_eye).sum(1, keepdims=True) * normal - to_eye
    nearest, hit = np.full(len(point), np.inf), np.zeros(len(point), int)
    for instance in scene.instances[1:]:
        mesh = scene.meshes[instance.mesh]
        for corners in mesh.positions[mesh.corner_vertex[mesh.triangles]].astype(np.float64):
            one, two = corners[1] - corners[0], corners[2] - corners[0]
            across = np.cross(ray, two)
            determinant = across @ one
            safe = np.where(np.abs(determinant) < 1e-12, np.inf, determinant)
            away = point - corners[0]
            x = (away * across).sum(1) / safe
            turned = np.cross(away, one)
            y = (ray * turned).sum(1) / safe
            distance = turned @ two / safe
            inside = (x >= 0.0) & (y >= 0.0) & (x + y <= 1.0) & (distance > 1e-6) & (distance < nearest)
            nearest[inside], hit[inside] = distance[inside], instance.object_id
    shown = frame.reflected_object()[mask]
    return float((shown != hit).mean()), float(((shown != hit) & (hit > 0)).mean())


@pytest.mark.parametrize("name", ["strongly bumpy", "kettle", "saddle"])
def test_more_of_what_is_seen_is_drawn(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    trial = crowded_trial(name)
    view = replace(trial.view, width=200, height=150)
    shares = []
    for images in (False, True):
        with monkeypatch.context() as patched:
            if not images:
                patched.setattr(MirrorSolver, "_more_images", lambda *_: [])
            renderer = Renderer(trial.scene, Settings(method="newton", samples=1))
            try:
                frame = renderer.render(view)
                shares.append(wrong_share(frame, trial.scene))
                vertices = frame.solve["vertices"]
                assert vertices == frame.solve["reflected"] + frame.solve["hidden"] + frame.solve["unconverged"]
            finally:
                renderer.free()
    (wrong, missing), (wrong_with, missing_with) = shares
    assert missing_with < 0.9 * missing
    assert wrong_with < 0.96 * wrong


@pytest.mark.parametrize("name", ["strongly bumpy", "kettle", "saddle"])
def test_edges_split_at_folds_show_more(name: str) -> None:
    """A triangle whose vertices show different images is not drawn; of its parts only those between them are not."""
    trial = crowded_trial(name)
    view = replace(trial.view, width=200, height=150)
    renderer = Renderer(trial.scene, Settings(method="newton", samples=1))
    try:
        shares = []
        for at_rest in (False, True):
            reflection = renderer.reflect(view, at_rest=at_rest)
            frame = Frame(reflection, None, {}, renderer.surfaces_of, trial.scene)
            shares.append(wrong_share(frame, trial.scene))
        (wrong, missing), (wrong_at_rest, missing_at_rest) = shares
        assert missing_at_rest < 0.95 * missing
        assert wrong_at_rest < wrong
    finally:
        renderer.free()


def test_a_convex_mirror_is_solved_once() -> None:
    trial = trials()[0]
    renderer = Renderer(trial.scene, Settings(method="newton", samples=1))
    try:
        reflection = renderer.reflect(trial.view)
        assert all(part.image == 0 for parts in reflection.parts for part in parts)
        (solver,) = renderer._preparation._solvers.values()
        assert solver._regions is None
    finally:
        renderer.free()
