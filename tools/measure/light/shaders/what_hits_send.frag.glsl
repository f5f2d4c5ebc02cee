// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Of what a ray has met: the share of light that it sends on, which side of it does, what it shines by itself.
#include "lighting/ggx.glsl"
#include "surfaces/material_at.glsl"
#include "surfaces/material_number.glsl"
#include "paths/path_state.glsl"
#include "gather/sent_on.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  albedo_out = side_out = shone_out = vec4(0.0);
  if (texelFetch(vertex_position, pixel, 0).w < 0.5) {
    return;
  }
  vec4 way = texelFetch(path_way, pixel, 0);
  vec4 normal = texelFetch(vertex_normal, pixel, 0);
  Material m = material_at(pixel, material_number(normal.w), texelFetch(vertex_color, pixel, 0).rgb);
  vec3 side = normal.xyz, of_lamps;
  albedo_out = vec4(sent_on(m, fract(way.x * 517.31 + way.y * 389.17), way_direction(way), side, of_lamps), 1.0);
  side_out = vec4(side, 0.0);
  shone_out = vec4(m.emission, 1.0);
}
