# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cube maps in numpy are held to the GPU's samplerCube, seams and corners too."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import sample_cube, texel_directions
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.cubes import cube_texture, read_cube
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.records import read_records, record_texture
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture
from curvrefl.gpu_shaders.loader import Snippet

pytestmark = pytest.mark.usefixtures("gpu")

STEPS_OF_FILTER_WEIGHTS = 256
"""GPUs need no finer ones"""
MAIN = "void main() { color = textureLod(cube, texelFetch(directions, ivec2(gl_FragCoord.xy), 0).xyz, 0.0); }"


def sampled_by_gpu(faces: np.ndarray, directions: np.ndarray, linear: bool = True) -> np.ndarray:
    """(m, 4) texels of the cube map in `directions` (m, 3)."""
    shader = build_shader(
        "cube sampling",
        FULL_SCREEN,
        Piece(
            samplers={"cube": "FLOAT_CUBE", "directions": "FLOAT_2D"},
            outputs={"color": "VEC4"},
            fragment=Snippet("test_cube_sampling", MAIN),
        ),
    )
    asked = record_texture(np.column_stack([directions, np.zeros(len(directions))]))
    answer = empty_texture(asked.width, asked.height)
    cube = cube_texture(faces, linear=linear)
    with frame_buffer(answer).bind(), drawing_state():
        set_viewport(0, 0, asked.width, asked.height)
        shader.bind()
        shader.uniform_sampler("cube", cube)
        shader.uniform_sampler("directions", asked)
        full_screen_triangle().draw(shader)
    return read_records(answer, len(directions))


def directions_of_all_kinds() -> dict[str, np.ndarray]:
    """Anywhere, close to an edge of the cube, close to a corner; all exact in float32."""
    rng = np.random.default_rng(5)
    anywhere = rng.normal(size=(3000, 3))
    on_face = anywhere / np.abs(anywhere).max(axis=1, keepdims=True)
    edges = on_face.copy()
    second = np.argsort(np.abs(edges), axis=1)[:, 1]
    rows = np.arange(len(edges))
    edges[rows, second] = np.sign(edges[rows, second]) * rng.uniform(0.9, 1.0, len(edges))
    corners = np.sign(on_face) * rng.uniform(0.93, 1.0, on_face.shape)
    kinds = {"anywhere": anywhere, "edges": edges, "corners": corners}
    return {name: each.astype(np.float32).astype(np.float64) for name, each in kinds.items()}


@pytest.mark.parametrize("kind", ["anywhere", "edges", "corners"])
@pytest.mark.parametrize("resolution", [4, 16, 128])
def test_seamless_sampling_is_the_gpu_s(resolution: int, kind: str) -> None:
    faces = np.random.default_rng(resolution).uniform(-1.0, 1.0, (6, resolution, resolution, 4)).astype(np.float32)
    directions = directions_of_all_kinds()[kind]
    difference = sampled_by_gpu(faces, directions) - sample_cube(faces, directions)
    # Random texels differ by up to 2 along s and along t.
    assert np.abs(difference).max() < 2.0 * 2.0 / STEPS_OF_FILTER_WEIGHTS


@pytest.mark.parametrize("resolution", [1, 5, 64])
def test_texels_lie_where_the_gpu_finds_them(resolution: int) -> None:
    faces = np.random.default_rng(0).normal(size=(6, resolution, resolution, 4)).astype(np.float32)
    directions = texel_directions(resolution).reshape(-1, 3)
    np.testing.assert_array_equal(sampled_by_gpu(faces, directions, linear=False), faces.reshape(-1, 4))
    np.testing.assert_array_equal(read_cube(cube_texture(faces)), faces)
