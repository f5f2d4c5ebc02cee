// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// How open each point of each patch (a fragment each) is, of one batch of links: how many of its rays have not met
// something close by, or the inside of something solid. A point in a crevice says nothing of what is seen.
#include "patches/batch.glsl"

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
    float link = texelFetch(links, texel_of_ray(place, ray), 0).x;
    bool is_shut = is_link_close(link) || patch_of_link(link) == LINK_WITHIN;
    open[ray % PATCH_POINTS] += is_shut ? 0.0 : 1.0;
  }
  color = open;
}
