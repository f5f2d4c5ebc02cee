// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Does this pixel's own reflected ray meet the triangle? Depth is the distance. Outputs as reflected.frag.glsl.
#include "surfaces/material_records.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 seen_color = texelFetch(mirror_color, pixel, 0);
  if (seen_color.w != mirror) {
    discard;
  }
  vec3 origin = texelFetch(mirror_position, pixel, 0).xyz;
  vec3 direction = reflect(normalize(origin * view.eye.w - view.eye.xyz), texelFetch(mirror_normal, pixel, 0).xyz);
  // As in ray_walk.glsl.
  vec3 p = cross(direction, edge_c);
  float determinant = dot(edge_b, p);
  vec3 offset = origin - corner_a;
  vec3 q = cross(offset, edge_b);
  float scale = 1.0 / determinant;
  vec2 place = vec2(dot(offset, p), dot(direction, q)) * scale;
  float range = dot(edge_c, q) * scale;
  if (!(place.x >= -OVERLAP && place.y >= -OVERLAP && place.x + place.y <= 1.0 + OVERLAP && range > 0.0)) {
    discard;
  }
  gl_FragDepth = range / (range + depth_scale);
  vec3 weights = vec3(1.0 - place.x - place.y, place);
  vec3 normal = vec3(0.0);
  for (int k = 0; k < 3; k++) {
    normal += weights[k] * fetch_record(corners, 2 * int(corner_numbers[k] + 0.5)).xyz;
  }
  bool is_front = dot(cross(edge_b, edge_c), direction) < 0.0;
  vec4 base = fetch_record(materials, MATERIAL_RECORDS * int(about.y + 0.5) + 2);
  surface_position = vec4(origin + range * direction, about.x);
  surface_normal = vec4(normalize(normal) * (is_front ? 1.0 : -1.0), about.y);
  surface_color_out = vec4(base.rgb, 0.0);
}
