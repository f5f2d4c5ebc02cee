// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The boxes of footprint_bounds, six vertices each, with what a fragment needs of the triangle inside.
#include "common/records.glsl"

void main()
{
  int box = 2 * (gl_VertexID / 6);
  int corner = gl_VertexID % 6;
  vec2 side = vec2(corner == 1 || corner == 2 || corner == 4 ? 1.0 : -1.0,
                   corner == 2 || corner == 4 || corner == 5 ? 1.0 : -1.0);
  vec4 first = fetch_record(boxes, box);
  vec4 second = fetch_record(boxes, box + 1);
  int triangle = 3 * int(second.z + 0.5);
  vec4 numbers = fetch_record(triangles, triangle);
  vec4 a = fetch_record(positions, int(numbers.x + 0.5));
  corner_a = a.xyz;
  edge_b = fetch_record(positions, int(numbers.y + 0.5)).xyz - a.xyz;
  edge_c = fetch_record(positions, int(numbers.z + 0.5)).xyz - a.xyz;
  about = vec2(a.w, numbers.w);
  corner_numbers = fetch_record(triangles, triangle + 2).xyz;
  gl_Position = vec4((first.xy + side.x * first.zw + side.y * second.xy) / screen * 2.0 - 1.0, 0.0, 1.0);
}
