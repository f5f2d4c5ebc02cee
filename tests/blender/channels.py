# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs set channels of materials to, computed on the GPU at places of one's choice."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture, texture_2d
from curvrefl.curvrefl_addon.renderer.programs.image_pages import ImagePages
from curvrefl.curvrefl_addon.scene.arrays import Float32Array, ImageSource, MaterialArrays
from curvrefl.curvrefl_addon.scene.programs.program import IMAGE_RECORDS
from curvrefl.gpu_shaders.loader import Snippet

INSTANCE_RECORDS = 12
LIBRARY = """
#include "programs/shading_point.glsl"
#include "programs/instances.glsl"
#include "programs/material.glsl"
"""
MAIN = """
void main()
{
  vec4 place = texelFetch(places, ivec2(gl_FragCoord.xy), 0);
  ShadingPoint s;
  s.position = vec3(place.xy, 0.0);
  s.normal = s.true_normal = vec3(0.0, 0.0, 1.0);
  s.incoming = normalize(vec3(sqrt(1.0 - place.w * place.w), 0.0, place.w));
  s.is_back = false;
  s.instance = 0;
  s.parametric = vec2(0.25);
  s.ray = RAY_IS_CAMERA;
  s.ray_length = 1.0;
  s.depths = vec3(0.0);
  s.more_depths = vec2(0.0);
  s.random = place.z;
  s.records = FIRST_RECORD;
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes[k] = vec4(place.xy, 0.0, 1.0);
  }
#ifdef PROGRAM_BUMP
  s.position_across = vec3(0.001, 0.0, 0.0);
  s.position_up = vec3(0.0, 0.001, 0.0);
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes_across[k] = vec4(s.position_across, 0.0);
    s.attributes_up[k] = vec4(s.position_up, 0.0);
  }
#endif
  Material m;
  material_program(s, m);
  color = vec4(vec3(m.CHANNEL), 1.0);
}
"""


def channel(
    material: MaterialArrays,
    name: str,
    u: Any,
    v: Any,
    random: Any = 0.5,
    cosine: Any = 1.0,
    images: Sequence[ImageSource] = (),
) -> Float32Array:
    """(n, 3) at n places of a plane whose coordinates of all kinds are (u, v); a number is three times the same.

    `random`: which sample it is. `cosine`: of the angle at which the plane is seen.
    """
    count = np.broadcast(*np.atleast_1d(u, v, random, cosine)).size
    if material.program is None or name not in material.program.shape.channels:
        return np.broadcast_to(np.array(getattr(material, name), np.float32), (count, 3))
    program, shape = material.program, material.program.shape
    pages = ImagePages()
    pages.follow(images)
    pages.fill()
    records = np.array(program.records, np.float32)
    for use in program.images:
        records[use.record : use.record + IMAGE_RECORDS] = pages.records(use.image)
    numbers = [*range(len(program.attributes)), *range(len(program.instance_attributes))][::-1]
    head = np.array([(number, 0.0, 0.0, 0.0) for number in numbers], np.float32).reshape(-1, 4)
    instance = np.zeros((INSTANCE_RECORDS + len(program.instance_attributes), 4), np.float32)
    instance[:3, :3] = instance[3:6, :3] = np.eye(3)
    instance[8] = 1.0
    places = np.zeros((1, count, 4), np.float32)
    for part, values in enumerate((u, v, random, cosine)):
        places[0, :, part] = values
    includes = LIBRARY + "".join(f'#include "{file}"\n' for file in shape.files)
    shader = build_shader(
        "program of a test",
        FULL_SCREEN,
        pages.piece,
        Piece(
            samplers=named("FLOAT_2D", "program_records", "instance_table", "places"),
            outputs={"color": "VEC4"},
            defines={
                "ATTRIBUTES": shape.attributes,
                "INSTANCE_VALUES": len(instance),
                "FIRST_RECORD": len(numbers),
                "CHANNEL": name,
                **flags(*sorted(shape.needs | {"PROGRAM_INSTANCE"})),
            },
            fragment=Snippet("program of a test", includes + shape.text + MAIN),
        ),
    )
    textures = {
        "program_records": record_texture(np.concatenate([head, records])),
        "instance_table": record_texture(instance),
        "places": texture_2d(places, "RGBA32F", False, "EXTEND"),
    }
    target = empty_texture(count, 1)
    with drawing_state(), frame_buffer(target).bind():
        set_viewport(0, 0, count, 1)
        shader.bind()
        pages.bind(shader)
        for sampler, texture in textures.items():
            shader.uniform_sampler(sampler, texture)
        full_screen_triangle().draw(shader)
    return read_texture(target)[0, :, :3]
