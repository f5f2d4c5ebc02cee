# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough mirrors while the view moves: as bright as they are, blurred as paths blur them, and calm."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.reflection import Reflection
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from curvrefl.curvrefl_addon.report.display import display_transform
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays, SceneArrays, WorldArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.settings_table import Settings
from scenes.paths.soft_room import soft_room, soft_view

pytestmark = pytest.mark.usefixtures("gpu")

VIEW = soft_view(96, 72)


def renderer_of(arrays: SceneArrays, samples: int = 1) -> Renderer:
    return Renderer(arrays, Settings(method="exact", samples=samples))


def moving(renderer: Renderer, view: View, last: Reflection | None = None) -> tuple[np.ndarray, Reflection]:
    """(h, w, 4) of the mirrors alone, as a viewport shows them first."""
    reflection = renderer.reflect(view, last=last)
    canvas = Canvas.of_size(view.width, view.height)
    renderer.add_sub_frame(canvas, reflection, 0, 1.0, mirrors_only=True)
    return canvas.pixels(), reflection


def shown(pixels: np.ndarray) -> np.ndarray:
    return 255.0 * display_transform(pixels[..., :3])


def test_only_rough_mirrors_that_move_are_blurred() -> None:
    for roughness, is_rough in ((0.0, False), (0.3, True)):
        renderer = renderer_of(soft_room(roughness))
        assert (renderer.reflect(VIEW).calm is not None) == is_rough
        assert renderer.reflect(VIEW).is_final != is_rough
        at_rest = renderer.reflect(VIEW, at_rest=True)
        assert at_rest.calm is None and at_rest.is_final
        renderer.free()
    arrays = soft_room(0.3)
    glass = MaterialArrays("glass", (1.0, 1.0, 1.0), roughness=0.3, transmission=1.0)
    renderer = renderer_of(replace(arrays, materials=(arrays.materials[0], glass, *arrays.materials[2:])))
    assert renderer.reflect(VIEW).calm is None, "what light goes through is no picture of its mirrors"
    renderer.free()


@pytest.mark.parametrize("roughness", [0.1, 0.6])
def test_an_even_world_stays_even(roughness: float) -> None:
    """A tinted mirror in a world of one color has that color times its tint (in half precision), to its edge."""
    arrays = soft_room(roughness, with_lamp=False)
    tinted = replace(arrays.materials[1], base_color=(0.8, 0.4, 0.2), glossy_only=True)
    arrays = replace(
        arrays,
        materials=(arrays.materials[0], tinted, *arrays.materials[2:]),
        instances=arrays.instances[:1],
        world=WorldArrays((0.5, 0.5, 0.5)),
    )
    renderer = renderer_of(arrays)
    pixels, _ = moving(renderer, VIEW)
    renderer.free()
    inside = pixels[..., 3] == 1.0
    assert inside.mean() > 0.1 and (pixels[~inside] == 0.0).all()
    np.testing.assert_allclose(pixels[inside][:, :3], np.tile((0.4, 0.2, 0.1), (inside.sum(), 1)), rtol=5e-4)


@pytest.mark.parametrize(("roughness", "most"), [(0.1, 5.0), (0.3, 5.0), (0.5, 7.0)])
def test_it_is_blurred_as_paths_blur_it(roughness: float, most: float) -> None:
    """Mean error by 1/255 as displayed; where a sharp mirror would have several times as much."""
    errors = []
    for drawn_as in (roughness, 0.0):
        renderer = renderer_of(soft_room(drawn_as))
        pixels, _ = moving(renderer, VIEW)
        renderer.free()
        errors.append(pixels)
    renderer = renderer_of(soft_room(roughness), 48)
    frame = renderer.render(VIEW)
    inside, truth = frame.mask() > 0, shown(frame.color())
    renderer.free()
    calm, sharp = (float(np.abs(shown(pixels) - truth)[inside].mean()) for pixels in errors)
    assert calm < most, (calm, sharp)
    assert calm < (0.8 if roughness < 0.2 else 0.5) * sharp, (calm, sharp)


def test_a_slow_orbit_is_calm() -> None:
    """No pixel changes by more than 8/255 from frame to frame of a hundredth of a degree; one path a pixel does."""
    renderer = renderer_of(soft_room(0.2))
    last, pictures, noisy = None, [], []
    for step in range(8):
        view = soft_view(96, 72, turn=0.01 * step)
        pixels, last = moving(renderer, view, last)
        pictures.append(shown(pixels))
        canvas = Canvas.of_size(view.width, view.height)
        renderer.add_sub_frame(canvas, replace(last, calm=None), step % 1, 1.0, mirrors_only=True)
        noisy.append(shown(canvas.pixels()))
    renderer.free()
    assert np.abs(np.diff(pictures, axis=0)).max() < 8.0
    assert np.abs(np.diff(noisy, axis=0)).max() > 16.0


def test_nothing_bleeds_from_a_mirror_into_another() -> None:
    """A mirror that shines stands before the ball: its light is nowhere on the ball."""
    arrays = soft_room(0.4)
    hidden = replace(arrays.instances[4], visible_glossy=False, visible_shadow=False)
    pictures = []
    for strength in (0.0, 50.0):
        shining = replace(arrays.materials[1], emission=(strength, 0.0, 0.0), name="shining")
        materials = (*arrays.materials, shining)
        instance = replace(hidden, materials=(len(materials) - 1,))
        changed = replace(
            arrays,
            materials=materials,
            instances=(*arrays.instances[:4], instance),
            reflectors=(*arrays.reflectors, instance.object_id),
        )
        renderer = renderer_of(changed)
        pixels, reflection = moving(renderer, VIEW)
        ball = renderer.render(VIEW).mask() == arrays.reflectors[0]
        assert reflection.calm is not None
        renderer.free()
        pictures.append(pixels[ball])
    np.testing.assert_array_equal(*pictures)
