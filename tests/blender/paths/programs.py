# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""GLSL functions of gpu_shaders/paths, run at arrays of numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.optics.scattering.sampler import path_point
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture, texture_2d
from curvrefl.curvrefl_addon.renderer.lighting.ggx import GGX_DEFINES, ggx_table
from curvrefl.curvrefl_addon.renderer.surfaces.materials import TABLE, Materials
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays, SceneArrays, WorldArrays
from curvrefl.gpu_shaders.loader import Snippet

FEATURES = ("ROUGH", "COAT", "GLASS", "ALPHA", "ANISOTROPY", "FILM", "SHEEN")
INPUTS = ("viewers", "lights", "randoms", "tangents")
OUTPUTS = ("direction_out", "weight_out", "value_out", "base_out")
MAIN = """
#include "paths/scatter.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 viewer = texelFetch(viewers, pixel, 0);
  vec4 light = texelFetch(lights, pixel, 0);
  vec4 tangent = texelFetch(tangents, pixel, 0);
  Material m = material_at(pixel, int(viewer.w + 0.5), texelFetch(colors, pixel, 0).rgb);
  Facing f = Facing(normal, tangent.xyz, light.w > 0.5);
  Scatter s = scatter(m, f, viewer.xyz, texelFetch(randoms, pixel, 0));
  direction_out = vec4(s.direction, s.pdf);
  weight_out = vec4(s.weight, float(s.kind));
  float pdf;
  vec3 value = scattered(m, f, viewer.xyz, light.xyz, pdf);
  value_out = vec4(value, pdf);
  base_out = vec4(base_share(m, f, dot(viewer.xyz, normal)), coat_passes(m, dot(viewer.xyz, normal)).g);
}
"""


@dataclass(frozen=True, slots=True)
class Answers:
    """Arrays of n rows."""

    direction: np.ndarray
    pdf: np.ndarray
    weight: np.ndarray
    kind: np.ndarray
    value: np.ndarray
    """Of `scattered` towards the lights"""
    value_pdf: np.ndarray
    base: np.ndarray
    coat_passes: np.ndarray


def scatter_program(features: tuple[str, ...] = FEATURES, main: str = MAIN, of_surfaces: tuple[str, ...] = ()) -> Any:
    return build_shader(
        "scatter of a test",
        FULL_SCREEN,
        TABLE,
        Piece(
            samplers=named("FLOAT_2D", "lighting_ggx", "colors", *INPUTS),
            constants={"normal": "VEC3"},
            outputs=named("VEC4", *OUTPUTS),
            defines={**GGX_DEFINES, **flags(*(f"PATHS_{name}" for name in features), *of_surfaces)},
            fragment=Snippet("scatter of a test", main),
        ),
    )


def scattering(
    materials: list[MaterialArrays],
    index: np.ndarray,
    viewers: np.ndarray,
    lights: np.ndarray,
    randoms: np.ndarray,
    is_back: np.ndarray | bool = False,
    tangents: np.ndarray | None = None,
    normal: tuple[float, float, float] = (0.0, 0.0, 1.0),
    program: Any = None,
) -> Answers:
    """scatter() and its sisters at n places: material numbers, unit directions to viewer and light, random numbers."""
    count = len(viewers)
    width = 256
    height = -(-count // width)
    table = Materials(SceneArrays((), (), tuple(materials), (), (), WorldArrays())).table

    def texture(rows: np.ndarray) -> Any:
        padded = np.zeros((width * height, 4), np.float32)
        padded[:count, : rows.shape[1]] = rows
        padded[count:] = padded[0]
        return texture_2d(padded.reshape(height, width, 4))

    if tangents is None:
        tangents = np.tile([1.0, 0.0, 0.0], (count, 1))
    back = np.broadcast_to(np.asarray(is_back, np.float64), (count,))
    colors = np.array([material.base_color for material in materials])[index]
    inputs = {
        "viewers": texture(np.column_stack([viewers, index])),
        "lights": texture(np.column_stack([lights, back])),
        "randoms": texture(randoms),
        "tangents": texture(tangents),
        "colors": texture(colors),
        "materials": table,
        "lighting_ggx": texture_2d(ggx_table(), linear=True),
    }
    outputs = [empty_texture(width, height) for _ in OUTPUTS]
    shader = program or scatter_program()
    with drawing_state(), frame_buffer(*outputs).bind():
        set_viewport(0, 0, width, height)
        shader.bind()
        shader.uniform_float("normal", normal)
        for name, value in inputs.items():
            shader.uniform_sampler(name, value)
        full_screen_triangle().draw(shader)
    direction, weight, value, base = (read_texture(output).reshape(-1, 4)[:count].astype(float) for output in outputs)
    return Answers(
        direction[:, :3],
        direction[:, 3],
        weight[:, :3],
        np.rint(weight[:, 3]).astype(int),
        value[:, :3],
        value[:, 3],
        base[:, :3],
        base[:, 3],
    )


RANDOM_MAIN = """
#include "paths/random.glsl"
void main()
{
  color = path_random(ivec2(gl_FragCoord.xy) + first_pixel);
}
"""


def randoms(
    width: int, height: int, sub_frame: int, bounce: int, asked: int, first_pixel: tuple[int, int]
) -> np.ndarray:
    """(height, width, 4) of path_random()."""
    shader = build_shader(
        "random of a test",
        FULL_SCREEN,
        Piece(
            constants={"path_point": "IVEC4", "first_pixel": "IVEC2"},
            outputs={"color": "VEC4"},
            fragment=Snippet("random of a test", RANDOM_MAIN),
        ),
    )
    target = empty_texture(width, height)
    with drawing_state(), frame_buffer(target).bind():
        set_viewport(0, 0, width, height)
        shader.bind()
        shader.uniform_int("path_point", path_point(sub_frame, bounce, asked))
        shader.uniform_int("first_pixel", first_pixel)
        full_screen_triangle().draw(shader)
    return read_texture(target)
