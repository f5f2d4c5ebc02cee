# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs give at the pixels of a tile of the board."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader, named
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture, texture_2d
from curvrefl.curvrefl_addon.renderer.programs.image_pages import ImagePages
from curvrefl.curvrefl_addon.renderer.programs.instance_table import InstanceTable
from curvrefl.curvrefl_addon.renderer.surfaces.view_block import VIEW, view_block
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.scene.materials.node_links import source_of
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from curvrefl.curvrefl_addon.scene.programs.builder import Builder
from curvrefl.curvrefl_addon.scene.programs.images import ProgramImages
from curvrefl.curvrefl_addon.scene.programs.program import Program
from curvrefl.curvrefl_addon.scene.programs.registry import HANDLERS
from curvrefl.gpu_shaders.loader import Snippet

from .stage import SIDE, judged_input
from .tiles import FIRST_ATTRIBUTE, INCOMING, NORMAL, PLACE, POSITION, corner_records, instance_table

NEEDS_VIEW = "PROGRAM_CAMERA"
LIBRARY = """
#include "programs/shading_point.glsl"
#include "programs/instances.glsl"
#include "programs/material.glsl"
"""
MAIN = """
vec4 corner(int quantity, int triangle, int k)
{
  return fetch_record(corners, 6 * quantity + 3 * triangle + k);
}

// Of the corners of a triangle, at a place of the tile (which may lie outside).
vec3 corner_weights(int triangle, vec2 place)
{
  vec2 a = corner(PLACE, triangle, 0).xy;
  vec2 b = corner(PLACE, triangle, 1).xy - a;
  vec2 c = corner(PLACE, triangle, 2).xy - a;
  place -= a;
  vec2 uv = vec2(place.x * c.y - place.y * c.x, b.x * place.y - b.y * place.x) / (b.x * c.y - b.y * c.x);
  return vec3(1.0 - uv.x - uv.y, uv);
}

vec4 at_weights(int quantity, int triangle, vec3 w)
{
  return w.x * corner(quantity, triangle, 0) + w.y * corner(quantity, triangle, 1) +
         w.z * corner(quantity, triangle, 2);
}

void main()
{
  float step = 2.0 / SIDE;
  vec2 place = texelFetch(places, ivec2(gl_FragCoord.xy), 0).xy;
  vec3 w = corner_weights(0, place);
  int triangle = min(w.x, min(w.y, w.z)) < 0.0 ? 1 : 0;
  w = corner_weights(triangle, place);
  vec3 across = corner_weights(triangle, place + vec2(step, 0.0)) - w;
  vec3 up = corner_weights(triangle, place + vec2(0.0, step)) - w;
  ShadingPoint s;
  s.position = at_weights(POSITION, triangle, w).xyz;
  s.normal = normalize(at_weights(NORMAL, triangle, w).xyz);
  s.true_normal = at_weights(INCOMING, triangle, w).xyz;
  s.incoming = s.true_normal;
  s.is_back = at_weights(NORMAL, triangle, w).w > 0.5;
  s.instance = 0;
  s.parametric = w.yz;
  s.ray = RAY_IS_CAMERA;
  s.ray_length = at_weights(INCOMING, triangle, w).w;
  s.depths = vec3(0.0);
  s.more_depths = vec2(0.0);
  s.origin = vec3(0.0);
  s.random = 0.5;
  s.records = FIRST_RECORD;
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes[k] = at_weights(FIRST_ATTRIBUTE + k, triangle, w);
  }
#ifdef PROGRAM_BUMP
  s.position_across = at_weights(POSITION, triangle, across).xyz;
  s.position_up = at_weights(POSITION, triangle, up).xyz;
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes_across[k] = at_weights(FIRST_ATTRIBUTE + k, triangle, across);
    s.attributes_up[k] = at_weights(FIRST_ATTRIBUTE + k, triangle, up);
  }
#endif
  Material m;
  m.emission = vec3(0.0);
  material_program(s, m);
  color = vec4(m.emission, 1.0);
}
"""


@dataclass(frozen=True, slots=True)
class Board:
    """What all programs of a board look at."""

    view: View
    images: ProgramImages
    pages: ImagePages

    @staticmethod
    def of_scene() -> Board:
        """As the camera of the scene sees it."""
        scene = bpy.context.scene
        width, height = scene.render.resolution_x, scene.render.resolution_y
        view = view_of_camera(scene, scene.camera, width, height, bpy.context.evaluated_depsgraph_get())
        return Board(view, ProgramImages(), ImagePages())

    def compiled(self, material: bpy.types.Material) -> tuple[Program, list[str]]:
        """The program of what a tile's material sends out, and the notes of what is left out."""
        notes: list[str] = []
        builder = Builder(HANDLERS, self.images, notes)
        known = len(self.images.remarks)
        # (Frames of sequences are those of evaluated nodes.)
        seen = material.evaluated_get(bpy.context.evaluated_depsgraph_get())
        value = builder.value(source_of(judged_input(seen)), "color")
        notes += [remark.cause for remark in self.images.remarks[known:]]
        return builder.finished({"emission": value}), notes

    def load_images(self) -> None:
        """Those of all that has been compiled."""
        self.pages.follow(self.images.sources)
        self.pages.fill()

    def evaluated(self, program: Program, tile: bpy.types.Object, places: np.ndarray) -> np.ndarray:
        """(SIDE, SIDE, 3) of what a program gives on a tile at places (SIDE, SIDE, 2) of it, rows from below."""
        instances = instance_table(program, tile)
        head = [float(instances.names.index(name)) for name in reversed(program.instance_attributes)]
        head += [float(k) for k in reversed(range(len(program.attributes)))]
        records = program.records.copy()
        for use in program.images:
            found = self.pages.records(use.image)
            records[use.record : use.record + len(found)] = found
        before = np.zeros((len(head), 4), np.float32)
        before[:, 0] = head
        textures = {
            "program_records": record_texture(np.concatenate([before, records])),
            "places": texture_2d(np.concatenate([places, np.zeros_like(places)], axis=2)),
            "corners": record_texture(corner_records(program, tile)),
        }
        shader = self._shader(program, instances)
        target, block = empty_texture(SIDE, SIDE), view_block(self.view)
        with drawing_state(), frame_buffer(target).bind():
            set_viewport(0, 0, SIDE, SIDE)
            shader.bind()
            if NEEDS_VIEW in program.shape.needs:
                shader.uniform_block("view", block)
            for name, texture in textures.items():
                shader.uniform_sampler(name, texture)
            instances.bind(shader)
            if program.images:
                self.pages.bind(shader)
            full_screen_triangle().draw(shader)
        return read_texture(target)[..., :3]

    def _shader(self, program: Program, instances: InstanceTable) -> Any:
        shape = program.shape
        pieces = [instances.piece]
        pieces += [VIEW] if NEEDS_VIEW in shape.needs else []
        pieces += [self.pages.piece] if program.images else []
        key = (shape, len(instances.names), *(str(piece.defines) for piece in pieces))
        if key not in _SHADERS:
            _SHADERS[key] = build_shader(
                "program of a test",
                FULL_SCREEN,
                *pieces,
                Piece(
                    samplers=named("FLOAT_2D", "program_records", "places", "corners"),
                    outputs={"color": "VEC4"},
                    defines={
                        "ATTRIBUTES": shape.attributes,
                        "FIRST_RECORD": shape.attributes + len(program.instance_attributes),
                        "SIDE": f"{SIDE}.0",
                        "PLACE": PLACE,
                        "POSITION": POSITION,
                        "NORMAL": NORMAL,
                        "INCOMING": INCOMING,
                        "FIRST_ATTRIBUTE": FIRST_ATTRIBUTE,
                        **{need: "" for need in sorted(shape.needs)},
                    },
                    fragment=Snippet(
                        "program of a test",
                        LIBRARY + "".join(f'#include "{file}"\n' for file in shape.files) + shape.text + MAIN,
                    ),
                ),
            )
        return _SHADERS[key]


_SHADERS: dict[Any, Any] = {}
