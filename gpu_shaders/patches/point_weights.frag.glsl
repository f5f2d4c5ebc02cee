// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// How open each point of each patch (a fragment each) is, of one batch of links: how many of its rays have not met
// something close by, or the inside of something solid. A point in a crevice says nothing of what is seen.
#include "common/records.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int place = (pixel.y << ROW_BITS) + pixel.x;
  color = vec4(0.0);
  if (place >= patches) {
    return;
  }
  vec4 open = vec4(0.0);
  for (int ray = 0; ray < RAYS_AT_ONCE; ray++) {
    int number = place * RAYS_AT_ONCE + ray;
    float link = texelFetch(links, ivec2(number % PICTURE_WIDTH, number / PICTURE_WIDTH), 0).x;
    bool is_close = fract(link) > 0.1 || link < -1.5;
    open[ray % PATCH_POINTS] += is_close ? 0.0 : 1.0;
  }
  color = open;
}
