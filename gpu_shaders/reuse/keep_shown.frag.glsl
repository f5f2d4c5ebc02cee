// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What mirrors show over the background: the surfaces that reflection points or rays have led to. With ON_PATH, only
// where a ray was followed, and what it has missed too: `share` tells how many mirrors were met before.
#include "surfaces/chosen_mirrors.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float number = texelFetch(seen_color, pixel, 0).w;
  if (number < 0.5 || !is_chosen(number)) {
    discard;
  }
  vec4 position = texelFetch(reflected_position, pixel, 0);
#ifdef ON_PATH
  if (texelFetch(path_depth, pixel, 0).x == 1.0) {
    discard;
  }
#else
  if (position.w < 0.5) {
    discard;
  }
#endif
  // (The fraction is the light set of what a ray has left.)
  shown_out = vec4(position.xyz, floor(position.w) + share);
}
