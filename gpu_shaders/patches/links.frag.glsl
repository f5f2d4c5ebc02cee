// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a ray from a patch has met, as a link (batch.glsl), and how much of what arrives there it sends on.
#include "lighting/ggx.glsl"
#include "surfaces/material_at.glsl"
#include "surfaces/material_number.glsl"
#include "patches/batch.glsl"
#include "patches/cells.glsl"
#include "paths/path_state.glsl"
#include "gather/sent_on.glsl"

// In cells.
#define CLOSE 0.25

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(vertex_position, pixel, 0);
  vec4 way = texelFetch(path_way, pixel, 0);
  link_out = vec4(float(LINK_NOTHING), vec3(0.0));
  if (way.z > 0.5) {
    link_out.x = float(LINK_WITHIN);
  }
  else if (position.w > 0.5) {
    vec4 normal = texelFetch(vertex_normal, pixel, 0);
    vec3 from = position.xyz - way.w * way_direction(way);
    bool is_close = way.w < CLOSE * cell_size(max(cell_level(from), 0.0));
    Material m = material_at(pixel, material_number(normal.w), texelFetch(vertex_color, pixel, 0).rgb);
    vec3 side = normal.xyz, of_lamps;
    link_out.yzw = sent_on(m, fract(way.x * 517.31 + way.y * 389.17), way_direction(way), side, of_lamps);
    link_out.x = float(patch_at(position.xyz, side)) + (is_close ? LINK_CLOSE : 0.0);
  }
}
