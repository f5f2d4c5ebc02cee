// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a ray from a patch to a place that shines has found: irradiance.
#include "surfaces/material_at.glsl"
#include "surfaces/material_number.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 radiance = vec3(0.0);
  if (texelFetch(vertex_position, pixel, 0).w > 0.5) {
    Material m = material_at(pixel, material_number(texelFetch(vertex_normal, pixel, 0).w), vec3(0.0));
    radiance = m.emission;
  }
  link_out = vec4(radiance * texelFetch(path_way, pixel, 0).z, 1.0);
}
