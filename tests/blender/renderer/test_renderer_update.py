# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A renderer that has followed a scene draws what a new one draws, and has made only what it had to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import LightArrays, SceneArrays, WorldArrays
from scenes.mirror_room import Room, radial_mesh
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
VIEW = look_at(np.array([0.0, -4.5, 2.0]), np.zeros(3), 120, 90, np.radians(40))
SETTINGS = Settings(samples=2)


def room() -> SceneArrays:
    made = Room()
    made.add_mirror(Ellipsoid(1.0, 0.8, 0.9), 64)
    made.add_ball((1.5, -1.6, 0.2), 0.4)
    made.add_ball((-1.6, -1.2, 0.0), 0.5)
    made.add_rectangle((0.0, 0.0, -1.2), (6.0, 0.0, 0.0), (0.0, 6.0, 0.0))
    lamp = LightArrays("lamp", "POINT", (900.0, 800.0, 700.0), placed((2.0, -3.0, 5.0)), radius=0.3)
    return replace(made.arrays(), lights=(lamp,))


def placed(place: tuple[float, float, float], turn: float = 0.0, scale: float = 1.0) -> np.ndarray:
    matrix = np.eye(4)
    c, s = np.cos(turn), np.sin(turn)
    matrix[:3, :3] = scale * np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    matrix[:3, 3] = place
    return matrix


def with_instance(scene: SceneArrays, index: int, **changes: object) -> SceneArrays:
    instances = list(scene.instances)
    instances[index] = replace(instances[index], **changes)  # type: ignore[arg-type]
    return replace(scene, instances=tuple(instances))


def move_ball(scene: SceneArrays) -> SceneArrays:
    return with_instance(scene, 1, matrix=placed((0.9, -1.9, 0.6), scale=0.4))


def move_ball_far(scene: SceneArrays) -> SceneArrays:
    return with_instance(scene, 1, matrix=placed((4.5, -1.0, 2.0), scale=0.4))


def move_floor(scene: SceneArrays) -> SceneArrays:
    return with_instance(scene, 3, matrix=placed((0.0, 0.0, -0.6)))


def turn_mirror(scene: SceneArrays) -> SceneArrays:
    return with_instance(scene, 0, matrix=placed((0.3, 0.2, 0.1), 0.7))


def stretch_mirror(scene: SceneArrays) -> SceneArrays:
    return with_instance(scene, 0, matrix=np.diag([0.7, 1.2, 1.0, 1.0]))


def edit_ball(scene: SceneArrays) -> SceneArrays:
    return replace(scene, meshes=(scene.meshes[0], radial_mesh(Bumpy(0.2), 48), *scene.meshes[2:]))


def edit_mirror(scene: SceneArrays) -> SceneArrays:
    return replace(scene, meshes=(radial_mesh(Bumpy(0.1), 64), *scene.meshes[1:]))


def wave_ball(scene: SceneArrays) -> SceneArrays:
    """Its vertices, and the normals with them, not the topology."""
    ball = scene.meshes[1]
    waves = 1.0 + 0.1 * np.sin(6.0 * ball.positions[:, 2:] + 1.0)
    normals = ball.corner_normals * np.array([1.0, 1.0, 1.4], np.float32)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    waved = replace(ball, positions=(ball.positions * waves).astype(np.float32), corner_normals=normals)
    return replace(scene, meshes=(scene.meshes[0], waved, *scene.meshes[2:]))


def wave_floor(scene: SceneArrays) -> SceneArrays:
    """No plane on the hull any more."""
    floor = scene.meshes[3]
    raised = floor.positions + np.array(
        [[0.0, 0.0, 0.4], [0.0, 0.0, 0.0], [0.0, 0.0, 0.2], [0.0, 0.0, 0.0]], np.float32
    )
    return replace(scene, meshes=(*scene.meshes[:3], replace(floor, positions=raised)))


def wave_mirror(scene: SceneArrays) -> SceneArrays:
    mirror = scene.meshes[0]
    squeezed = mirror.positions * np.array([1.0, 0.9, 0.8], np.float32)
    return replace(scene, meshes=(replace(mirror, positions=squeezed), *scene.meshes[1:]))


def paint_ball(scene: SceneArrays) -> SceneArrays:
    return replace(scene, materials=(replace(scene.materials[0], base_color=(1.0, 0.1, 0.1)), *scene.materials[1:]))


def dim(scene: SceneArrays) -> SceneArrays:
    return replace(scene, lights=(replace(scene.lights[0], color=(90.0, 10.0, 10.0)),))


def move_lamp(scene: SceneArrays) -> SceneArrays:
    return replace(scene, lights=(replace(scene.lights[0], matrix=placed((-3.0, -1.0, 3.0))),))


def brighten(scene: SceneArrays) -> SceneArrays:
    return replace(scene, world=WorldArrays((2.0, 1.0, 0.5)))


def remove_ball(scene: SceneArrays) -> SceneArrays:
    return replace(scene, instances=(scene.instances[0], *scene.instances[2:]))


def second_mirror(scene: SceneArrays) -> SceneArrays:
    scene = with_instance(scene, 2, materials=(1,))
    return replace(scene, reflectors=(1, 3))


def no_shadow(scene: SceneArrays) -> SceneArrays:
    return with_instance(scene, 1, visible_shadow=False)


@pytest.mark.parametrize(
    ("act", "baked"),
    [
        (move_ball, 0),
        (move_ball_far, 0),
        (move_floor, 0),
        (turn_mirror, 0),
        (stretch_mirror, 1),
        (edit_ball, 0),
        (edit_mirror, 1),
        (wave_ball, 0),
        (wave_floor, 0),
        (wave_mirror, 1),
        (paint_ball, 0),
        (dim, 0),
        (move_lamp, 0),
        (brighten, 0),
        (remove_ball, 0),
        (second_mirror, 1),
        (no_shadow, 0),
    ],
)
def test_following_is_as_starting_anew(act: Callable[[SceneArrays], SceneArrays], baked: int) -> None:
    scene = room()
    renderer = Renderer(scene, SETTINGS)
    before = renderer.render(VIEW).color()
    changed = act(scene)
    renderer.update(changed)
    found = renderer.render(VIEW).color()
    assert renderer.counters["maps baked"] == 1 + baked
    expected = Renderer(changed, SETTINGS).render(VIEW).color()
    # A mirror that only turned keeps the texels that it was baked into: elsewhere in the world than a new bake's.
    limit = 0.02 if act is turn_mirror else 2e-3
    assert np.abs(found - expected).mean() < limit * expected[..., :3].mean()
    assert np.abs(found - before).mean() > 1e-3 * before[..., :3].mean()
    renderer.update(scene)
    back = renderer.render(VIEW).color()
    assert np.abs(back - before).mean() < limit * before[..., :3].mean()


def test_settings_change_without_a_new_start() -> None:
    scene = room()
    renderer = Renderer(scene, SETTINGS)
    other = Settings(samples=4, map_resolution=64, pixel_tolerance=2.0)
    renderer.configure(other)
    assert renderer.counters["maps baked"] == 2
    found = renderer.render(VIEW).color()
    expected = Renderer(scene, other).render(VIEW).color()
    assert np.abs(found - expected).mean() < 2e-3 * expected[..., :3].mean()
    with pytest.raises(InputError, match="samples"):
        renderer.configure(Settings(samples=0))
    assert renderer.settings is other


def test_environments_outlast_a_change_of_method() -> None:
    scene = room()
    renderer = Renderer(scene, replace(SETTINGS, method="environment_cube"))
    renderer.render(VIEW)
    (cube,) = renderer.environment_cubes()
    for method in ("secant_star", "exact", "environment_sphere"):
        renderer.configure(replace(SETTINGS, method=method))
        renderer.render(VIEW)
    assert renderer.environment_cubes() == [cube]
    expected = Renderer(scene, replace(SETTINGS, method="environment_sphere")).render(VIEW).color()
    assert np.abs(renderer.render(VIEW).color() - expected).mean() < 1e-4 * expected[..., :3].mean()
    for other in (replace(SETTINGS, environment_resolution=64), replace(SETTINGS, map_resolution=64)):
        renderer.configure(replace(other, method="environment_sphere"))
        assert renderer.environment_cubes() != [cube]
