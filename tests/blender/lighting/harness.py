# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A stage lit by `Lighting`: the points, normals and materials that Cycles has."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader, named
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture, texture_2d
from curvrefl.curvrefl_addon.renderer.geometry.scene_geometry import SceneGeometry
from curvrefl.curvrefl_addon.renderer.lighting.lighting import FEATURES, Lighting, lighting_piece
from curvrefl.curvrefl_addon.renderer.surfaces.materials import Materials
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays
from curvrefl.gpu_shaders.loader import Snippet
from lighting.cycles import build_blender
from lighting.stage import Body, Stage, camera_matrix, scene_arrays
from mathutils import Vector


def surface_buffers(stage: Stage) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Position, normal, direction to the viewer (pixels, pixels, 3) and body index (-1 background) at pixel centers."""
    build_blender(stage)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    matrix = camera_matrix(stage)
    forward = Vector(-matrix[:3, 2])
    bodies = [placed for placed in bpy.context.scene.objects if placed.type == "MESH"]
    size = stage.pixels
    positions, normals = np.zeros((size, size, 3)), np.zeros((size, size, 3))
    number = np.full((size, size), -1)
    for row in range(size):
        for column in range(size):
            u, v = ((np.array([column, row]) + 0.5) / size - 0.5) * stage.width
            origin = Vector(matrix[:3, 3] + u * matrix[:3, 0] + v * matrix[:3, 1])
            hit, place, normal, _, placed, _ = bpy.context.scene.ray_cast(depsgraph, origin, forward)
            if not hit:
                continue
            index = [body.name for body in bodies].index(placed.name)
            center = stage.bodies[index].smooth_center
            positions[row, column] = place
            normals[row, column] = normal if center is None else (place - Vector(center)).normalized()
            number[row, column] = index
    viewers = np.broadcast_to(matrix[:3, 2], positions.shape)
    return positions, normals, viewers, number


def our_picture(stage: Stage, sub_frames: int = 16, function: str = "shade_surface") -> tuple[np.ndarray, np.ndarray]:
    """The same as `cycles_picture` by `Lighting`, and the body indices."""
    require_gpu()
    positions, normals, viewers, number = surface_buffers(stage)
    scene = scene_arrays(stage)
    geometry = SceneGeometry()
    geometry.update(scene, {})
    lighting = Lighting(scene, geometry, Materials(scene), sub_frames)
    harness = Harness(lighting, positions, normals, viewers, number, stage.bodies, function)
    total = np.zeros((stage.pixels, stage.pixels, 3))
    for sub_frame in range(sub_frames):
        total += harness.shade(sub_frame)
    picture = total / sub_frames
    lighting.free()
    return picture, number


class Harness:
    """A shade pass over given surface buffers."""

    def __init__(
        self,
        lighting: Lighting,
        positions: np.ndarray,
        normals: np.ndarray,
        viewers: np.ndarray,
        number: np.ndarray,
        bodies: list[Body],
        function: str = "shade_surface",
    ) -> None:
        self.lighting = lighting
        shape = positions.shape[:2]

        def texture(array: np.ndarray) -> Any:
            full = np.zeros((*shape, 4), np.float32)
            full[..., : array.shape[-1]] = array
            return texture_2d(full)

        materials = [body.material for body in bodies] or [MaterialArrays("none")]
        base = np.array([m.base_color for m in materials])[number]
        gloss = np.array([[m.metallic, m.roughness, m.ior, m.specular_level] for m in materials])[number]
        extra = np.array([[*m.emission, float(m.glossy_only)] for m in materials])[number]
        sheen = np.array([[m.sheen_weight * part for part in m.sheen_tint] for m in materials])[number]
        coat = np.array([[m.coat_weight, m.coat_roughness, m.coat_ior, m.sheen_roughness] for m in materials])[number]
        coat_tint = np.array([[*m.coat_tint, m.translucency] for m in materials])[number]
        tint = np.array([[*m.specular_tint, m.diffuse_roughness] for m in materials])[number]
        self.textures = {
            "position": texture(np.concatenate([positions, number[..., None] + 1.0], axis=-1)),
            "normal": texture(normals),
            "viewer": texture(viewers),
            "base": texture(base),
            "gloss": texture(gloss),
            "extra": texture(extra),
            "sheen": texture(sheen),
            "coat": texture(coat),
            "coat_tint": texture(coat_tint),
            "tint": texture(tint),
        }
        self.shader = build_shader(
            "lighting test",
            FULL_SCREEN,
            lighting_piece(FEATURES | lighting.features),
            Piece(
                samplers=named("FLOAT_2D", *(f"buffer_{name}" for name in self.textures)),
                outputs={"color": "VEC4"},
                fragment=Snippet("harness", _MAIN.replace("FUNCTION", function)),
            ),
        )
        self.target = empty_texture(shape[1], shape[0])
        self.frame_buffer = frame_buffer(self.target)

    def draw(self, sub_frame: int) -> None:
        self.lighting.prepare(sub_frame)
        with drawing_state(), self.frame_buffer.bind():
            set_viewport(0, 0, self.target.width, self.target.height)
            self.shader.bind()
            for name, texture in self.textures.items():
                self.shader.uniform_sampler(f"buffer_{name}", texture)
            self.lighting.bind(self.shader)
            full_screen_triangle().draw(self.shader)

    def shade(self, sub_frame: int) -> np.ndarray:
        self.draw(sub_frame)
        return read_texture(self.target)[..., :3].astype(np.float64)


_MAIN = """
#include "lighting/lighting.glsl"

vec3 mirror_at(Surface s, vec3 to_viewer)
{
  float cosine = max(dot(s.normal, to_viewer), 0.0);
  return sharp_reflectance(s.base_color, s.metallic, s.ior, s.specular_level, s.glossy_only, cosine);
}

vec3 world_and_lamps_at(Surface s, vec3 to_viewer)
{
  vec3 direction = reflect(-to_viewer, s.normal);
  return mirror_at(s, to_viewer) * (world_radiance(direction) + lamps_seen(s.position, direction, 2e30, false).rgb);
}

vec3 lamps_nearer_than_2(Surface s, vec3 to_viewer)
{
  return lamps_seen(s.position, reflect(-to_viewer, s.normal), 2.0, false).rgb;
}

vec3 lamps_nearer_than_4(Surface s, vec3 to_viewer)
{
  return lamps_seen(s.position, reflect(-to_viewer, s.normal), 4.0, false).rgb;
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(buffer_position, pixel, 0);
  vec4 gloss = texelFetch(buffer_gloss, pixel, 0);
  vec4 extra = texelFetch(buffer_extra, pixel, 0);
  vec3 to_viewer = texelFetch(buffer_viewer, pixel, 0).xyz;
  vec4 coat = texelFetch(buffer_coat, pixel, 0);
  vec4 coat_tint = texelFetch(buffer_coat_tint, pixel, 0);
  vec4 tint = texelFetch(buffer_tint, pixel, 0);
  Material m;
  m.base_color = texelFetch(buffer_base, pixel, 0).rgb;
  m.metallic = gloss.x;
  m.roughness = gloss.y;
  m.ior = gloss.z;
  m.specular_level = gloss.w;
  m.emission = extra.rgb;
  m.glossy_only = extra.w > 0.5;
  m.sheen_tint = texelFetch(buffer_sheen, pixel, 0).rgb;
  m.sheen_weight = 1.0;
  m.coat_weight = coat.x;
  m.coat_roughness = coat.y;
  m.coat_ior = coat.z;
  m.sheen_roughness = coat.w;
  m.coat_tint = coat_tint.rgb;
  m.translucency = coat_tint.w;
  m.specular_tint = tint.rgb;
  m.diffuse_roughness = tint.w;
  m.subsurface = 0.0;
  Surface s = surface_made_of(m, position.xyz, texelFetch(buffer_normal, pixel, 0).xyz);
  color = vec4(world_radiance(-to_viewer), 1.0);
  if (position.w > 0.5) {
    color.rgb = FUNCTION(s, to_viewer);
  }
}
"""
