// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The first level: what rough mirrors show, without the mirrors' own color, which stays sharp.
#include "calm/calm_level.glsl"
#include "calm/calm_tint.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(calm_reach, pixel, 0).x == 0.0) {
    color = vec4(0.0);
    return;
  }
  vec3 light = texelFetch(sharp_picture, pixel, 0).rgb / max(tint_at(pixel), vec3(DARKEST_TINT));
  color = level_texel(light, texelFetch(seen_color, pixel, 0).w, 1.0);
}
