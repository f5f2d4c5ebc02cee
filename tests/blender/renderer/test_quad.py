# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the four pixels of a quad tell each other (quad.glsl)."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader, named
from curvrefl.curvrefl_addon.renderer.device.state import set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture, texture_2d
from curvrefl.gpu_shaders.loader import Snippet

pytestmark = pytest.mark.usefixtures("gpu")

SIZE = 8
MAIN = """
#include "lighting/quad.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 place = texelFetch(places, pixel, 0);
  vec4 facing = texelFetch(facings, pixel, 0);
  vec4 numbers = quad_sum(texelFetch(values, pixel, 0));
  float joins = quad_is_one_surface(place.xyz, facing.xyz, vec3(place.w, facing.w, 0.0)) ? 1.0 : 0.0;
  color = vec4(numbers.xy, float(quad_lane()), joins);
}
"""


def drawn(values: np.ndarray, places: np.ndarray, facings: np.ndarray) -> np.ndarray:
    """(h, w, 4): sums of the first two values over the quad, number in the quad, whether it is one surface."""
    shader = build_shader(
        "quad",
        FULL_SCREEN,
        Piece(
            samplers=named("FLOAT_2D", "values", "places", "facings"),
            outputs={"color": "VEC4"},
            fragment=Snippet("test_quad", MAIN),
        ),
    )
    textures = [texture_2d(array.astype(np.float32)) for array in (values, places, facings)]
    target = empty_texture(SIZE, SIZE)
    with frame_buffer(target).bind():
        set_viewport(0, 0, SIZE, SIZE)
        shader.bind()
        for name, texture in zip(("values", "places", "facings"), textures, strict=True):
            shader.uniform_sampler(name, texture)
        full_screen_triangle().draw(shader)
    return read_texture(target)


def plane() -> tuple[np.ndarray, np.ndarray]:
    """Places and facings of a plane seen at a slant, all of one object and material."""
    y, x = np.mgrid[0:SIZE, 0:SIZE].astype(np.float64)
    places = np.stack([0.1 * x, 0.3 * y, 0.2 * y, np.full_like(x, 7.0)], axis=-1)
    normal = np.array([0.0, -0.2, 0.3]) / np.hypot(0.2, 0.3)
    return places, np.broadcast_to([*normal, 2.0], (SIZE, SIZE, 4)).copy()


def test_sums_over_two_by_two() -> None:
    values = np.random.default_rng(1).uniform(-1.0, 1.0, (SIZE, SIZE, 4))
    found = drawn(values, *plane())
    blocks = values.reshape(SIZE // 2, 2, SIZE // 2, 2, 4).sum(axis=(1, 3))
    expected = blocks.repeat(2, axis=0).repeat(2, axis=1)
    assert np.abs(found[..., :2] - expected[..., :2]).max() < 2e-6
    y, x = np.mgrid[0:SIZE, 0:SIZE]
    assert np.array_equal(found[..., 2], x % 2 + 2 * (y % 2))
    assert (found[..., 3] == 1.0).all()


def _other_object(places: np.ndarray, _facings: np.ndarray) -> None:
    places[2, 5, 3] = 8.0


def _other_material(_places: np.ndarray, facings: np.ndarray) -> None:
    facings[2, 5, 3] = 3.0


def _turned(_places: np.ndarray, facings: np.ndarray) -> None:
    facings[2, 5, :3] = (0.6, 0.0, 0.8)


def _step(places: np.ndarray, facings: np.ndarray) -> None:
    places[2, 5, :3] -= 0.2 * facings[2, 5, :3]


def _no_number(places: np.ndarray, _facings: np.ndarray) -> None:
    places[2, 5, 0] = np.nan


@pytest.mark.parametrize("change", [_other_object, _other_material, _turned, _step, _no_number])
def test_four_that_are_not_one_surface_all_know(change) -> None:  # type: ignore[no-untyped-def]
    places, facings = plane()
    change(places, facings)
    expected = np.ones((SIZE, SIZE))
    expected[2:4, 4:6] = 0.0
    assert np.array_equal(drawn(np.zeros((SIZE, SIZE, 4)), places, facings)[..., 3], expected)
