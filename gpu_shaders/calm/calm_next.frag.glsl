// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The next level: four texels in one, of the mirror alone that covers most of them.
#include "calm/calm_level.glsl"

void main()
{
  ivec2 base = 2 * ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(finer, 0) - 1;
  vec4 texels[4];
  for (int k = 0; k < 4; k++) {
    ivec2 place = base + ivec2(k & 1, k >> 1);
    texels[k] = all(lessThanEqual(place, last)) ? texelFetch(finer, place, 0) : vec4(0.0);
  }
  float number = 0.0, most = 0.0;
  for (int k = 0; k < 4; k++) {
    float share = 0.0;
    for (int other = 0; other < 4; other++) {
      share += number_of(texels[other]) == number_of(texels[k]) ? share_of(texels[other]) : 0.0;
    }
    if (share > most) {
      most = share;
      number = number_of(texels[k]);
    }
  }
  vec3 light = vec3(0.0);
  for (int k = 0; k < 4; k++) {
    light += number_of(texels[k]) == number ? texels[k].rgb : vec3(0.0);
  }
  color = level_texel(0.25 * light, number, 0.25 * most);
}
