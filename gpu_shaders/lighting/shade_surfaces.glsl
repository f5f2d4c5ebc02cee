// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces out of the buffers of renderer/surfaces/surfaces.py. Needs the uniform block `view` and the sampler
// `materials`.
#include "surfaces/material_at.glsl"
#include "surfaces/material_number.glsl"
#include "programs/surface.glsl"

// At a pixel of surface buffers.
Surface surface_of(ivec2 pixel, vec4 position, vec4 normal, vec3 color)
{
  Material m = material_at(pixel, material_number(normal.w), color);
  return surface_made_of(m, position.xyz, normal.xyz);
}

vec3 world_point(vec2 ndc, float depth)
{
  vec4 point = view.clip_to_world * vec4(ndc, depth, 1.0);
  return point.xyz / point.w;
}

// The ray through this pixel: where it leaves the picture plane, and its unit direction.
void pixel_ray(ivec2 size, out vec3 origin, out vec3 direction)
{
  vec2 ndc = 2.0 * gl_FragCoord.xy / vec2(size) - 1.0;
  origin = world_point(ndc, -1.0);
  direction = normalize(world_point(ndc, 1.0) - origin);
}
