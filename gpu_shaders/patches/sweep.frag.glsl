// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light that one batch of links brings to each patch (a fragment each): the sum over its rays, and how many count.
#include "common/records.glsl"
#include "patches/batch.glsl"
#include "patches/point_weight.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int place = (pixel.y << ROW_BITS) + pixel.x;
  color = vec4(0.0);
  if (place >= patches) {
    return;
  }
  vec4 weights = weights_of_points(texelFetch(point_weights, pixel, 0));
  for (int ray = 0; ray < RAYS_AT_ONCE; ray++) {
    vec4 link = texelFetch(links, texel_of_ray(place, ray), 0);
    int other = patch_of_link(link.x);
    float counts = other != LINK_WITHIN ? weights[ray % PATCH_POINTS] : 0.0;
    color.w += counts;
    if (other >= 0 && counts > 0.0) {
      color.rgb += counts * link.yzw * fetch_record(patch_sent, other).rgb;
    }
  }
}
