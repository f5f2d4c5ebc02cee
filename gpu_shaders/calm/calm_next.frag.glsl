// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The next level: four by four texels in one, by the weights 1, 3, 3, 1 of a smooth kernel, of the mirror alone that
// covers most of the inner four.
#include "calm/calm_level.glsl"

vec4 finer_texel(ivec2 place)
{
  ivec2 last = textureSize(finer, 0) - 1;
  return place == clamp(place, ivec2(0), last) ? texelFetch(finer, place, 0) : vec4(0.0);
}

void main()
{
  ivec2 base = 2 * ivec2(gl_FragCoord.xy);
  vec4 inner[4];
  for (int k = 0; k < 4; k++) {
    inner[k] = finer_texel(base + ivec2(k & 1, k >> 1));
  }
  float number = 0.0, most = 0.0;
  for (int k = 0; k < 4; k++) {
    float share = 0.0;
    for (int other = 0; other < 4; other++) {
      share += number_of(inner[other]) == number_of(inner[k]) ? share_of(inner[other]) : 0.0;
    }
    if (share > most) {
      most = share;
      number = number_of(inner[k]);
    }
  }
  vec4 sum = vec4(0.0);
  if (most > 0.0) {
    const float weights[4] = float[4](0.125, 0.375, 0.375, 0.125);
    for (int y = 0; y < 4; y++) {
      for (int x = 0; x < 4; x++) {
        vec4 texel = finer_texel(base + ivec2(x, y) - 1);
        if (number_of(texel) == number) {
          sum += weights[x] * weights[y] * vec4(texel.rgb, share_of(texel));
        }
      }
    }
  }
  color = level_texel(sum.rgb, number, sum.a);
}
