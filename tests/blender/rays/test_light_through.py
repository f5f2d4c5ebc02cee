# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow rays through what light goes straight on through: the product of what each surface lets on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.lighting import lighting
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import (
    ImageSource,
    LightArrays,
    MaterialArrays,
    SceneArrays,
    WorldArrays,
)
from scenes.mirror_room import Room
from scenes.paths.programs import Looked, cut_out, source_of, with_attributes
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
VIEW = look_at(np.array([0.0, -5.5, 0.6]), np.zeros(3), 160, 120, 0.6)
HALF = 0.7
CLEAR = MaterialArrays("clear", specular_level=0.0)


def under_sheets(*materials: MaterialArrays, images: tuple[ImageSource, ...] = ()) -> SceneArrays:
    """A sun from above, sheets over a floor, which a mirror shows and nothing else of them."""
    room = Room()
    room.add_mirror(Ellipsoid(), 128)
    room.add_rectangle((0.0, 0.0, -1.2), (8.0, 0.0, 0.0), (0.0, 8.0, 0.0))
    hidden = {"visible_glossy": False, "visible_camera": False}
    for number in range(len(materials)):
        room.add_rectangle((0.0, -2.5, 1.6 + 0.1 * number), (HALF, 0.0, 0.0), (0.0, HALF, 0.0), **hidden)
    arrays = room.arrays()
    first = len(arrays.materials)
    uv = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], np.float32)
    return replace(
        arrays,
        meshes=(*arrays.meshes[:2], *(with_attributes(mesh, uv=uv) for mesh in arrays.meshes[2:])),
        instances=(
            *arrays.instances[:2],
            *(replace(item, materials=(first + number,)) for number, item in enumerate(arrays.instances[2:])),
        ),
        materials=(*arrays.materials, *materials),
        images=images,
        lights=(LightArrays("sun", "SUN", (3.0, 3.0, 3.0), np.eye(4)),),
        world=WorldArrays(),
    )


def drawn(scene: SceneArrays) -> Frame:
    renderer = Renderer(scene, Settings(method="exact", samples=1, shadow_rays=True))
    frame = renderer.render(VIEW)
    frame.surfaces  # noqa: B018  (read while the renderer is there)
    renderer.free()
    return frame


def light_through(scene: SceneArrays) -> tuple[np.ndarray, np.ndarray]:
    """What gets to the floor where the mirror shows it under the sheets (n, 3), and where (n, 2), -1..1 of a sheet."""
    frame, bare = drawn(scene), drawn(under_sheets())
    place = (frame.reflected_position()[..., :2] - (0.0, -2.5)) / HALF
    below = (frame.mask() > 0) & (frame.reflected_object() == 2) & (np.abs(place).max(axis=-1) < 0.97)
    assert below.sum() > 30
    return (frame.color()[..., :3] / np.maximum(bare.color()[..., :3], 1e-9))[below], place[below]


@pytest.mark.parametrize(
    ("materials", "expected"),
    [
        ([replace(CLEAR, alpha=0.5)], (0.5, 0.5, 0.5)),
        ([replace(CLEAR, alpha=0.5), replace(CLEAR, alpha=0.3)], (0.35, 0.35, 0.35)),
        ([replace(CLEAR, alpha=0.2, transparent_tint=(1.0, 0.5, 0.25))], (0.8, 0.4, 0.2)),
        ([replace(CLEAR, alpha=0.0)], (1.0, 1.0, 1.0)),
        ([replace(CLEAR, alpha=0.0), replace(CLEAR, alpha=0.5)], (0.5, 0.5, 0.5)),
        ([replace(CLEAR, alpha=0.5), CLEAR], (0.0, 0.0, 0.0)),
        ([replace(CLEAR, alpha=0.5), replace(CLEAR, transmission=1.0)], (0.0, 0.0, 0.0)),
    ],
    ids=["one", "two", "tinted", "nothing", "nothing and one", "opaque", "glass"],
)
def test_the_product_of_what_each_surface_lets_on(
    materials: list[MaterialArrays], expected: tuple[float, float, float]
) -> None:
    light, _ = light_through(under_sheets(*materials))
    assert np.abs(light - expected).max() < 2e-3


def test_alpha_of_an_image_is_looked_up_where_the_ray_passes() -> None:
    """Two halves, of which one is there, and a ramp across them on another sheet."""
    halves, ramp = np.ones((1, 2, 4), np.float32), np.ones((2, 2, 4), np.float32)
    halves[0, :, 3] = (0.0, 1.0)
    ramp[..., 3] = ((0.0, 0.0), (1.0, 1.0))
    images = (source_of("halves", halves), source_of("ramp", ramp))
    cut = cut_out(CLEAR, Looked(0, is_nearest=True), threshold=0.5)
    soft = cut_out(CLEAR, Looked(1, "EXTEND"))
    light, place = light_through(under_sheets(cut, soft, images=images))
    across, up = place[:, 0], 0.5 * place[:, 1] + 0.5
    assert (light[across > 0.02] == 0.0).all()
    expected = 1.0 - np.clip(2.0 * up - 0.5, 0.0, 1.0)
    clear = across < -0.02
    assert clear.sum() > 20
    assert np.abs(light[clear] - expected[clear, None]).max() < 5e-3


def test_the_world_gets_through_by_rays_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where its maps are said to be too coarse, in a still: of a sheet that hides nearly all of the sky."""
    monkeypatch.setattr(lighting, "are_too_coarse", lambda *_: True)
    view = look_at(np.array([0.0, -5.5, 0.6]), np.zeros(3), 80, 60, 0.6)
    pictures = []
    for material in (replace(CLEAR, alpha=0.0), replace(CLEAR, alpha=0.4, transparent_tint=(1.0, 0.5, 0.25))):
        room = Room()
        room.add_mirror(Ellipsoid(), 128)
        room.add_rectangle((0.0, 0.0, -1.2), (8.0, 0.0, 0.0), (0.0, 8.0, 0.0))
        room.add_rectangle((0.0, 0.0, 1.6), (400.0, 0.0, 0.0), (0.0, 400.0, 0.0), visible_glossy=False)
        arrays = room.arrays()
        instances = (*arrays.instances[:2], replace(arrays.instances[2], materials=(2,)))
        materials = (replace(arrays.materials[0], specular_level=0.0), arrays.materials[1], material)
        renderer = Renderer(
            replace(arrays, instances=instances, materials=materials), Settings(method="exact", samples=8)
        )
        frame = renderer.render(view)
        on_floor = (frame.mask() > 0) & (frame.reflected_object() == 2)
        pictures.append(frame.color()[on_floor][:, :3])
        renderer.free()
    assert on_floor.sum() > 80
    light = pictures[1].mean(axis=0) / pictures[0].mean(axis=0)
    # (Pixels at the floor's edge show some of the sky.)
    assert light == pytest.approx(np.array([0.6, 0.3, 0.15]), abs=0.015)
