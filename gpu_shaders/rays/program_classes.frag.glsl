// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which program makes the material of what a ray has just hit, as a depth: its number plus one over PROGRAM_STEPS, 1
// where there is none. `followed`: depths of which `followed_depth` says that a ray was followed: below 0 all
// less than 1 do.
#include "surfaces/material_records.glsl"
#include "surfaces/material_number.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  gl_FragDepth = 1.0;
  float now = texelFetch(followed, pixel, 0).x;
  bool is_followed = followed_depth < 0.0 ? now < 1.0 : now == followed_depth;
  if (is_followed && texelFetch(vertex_position, pixel, 0).w != 0.0) {
    int index = material_number(texelFetch(vertex_normal, pixel, 0).w);
    float program = fetch_record(materials, MATERIAL_RECORDS * index + 2).w;
    gl_FragDepth = program < -0.5 ? 1.0 : (program + 1.0) / PROGRAM_STEPS;
  }
}
