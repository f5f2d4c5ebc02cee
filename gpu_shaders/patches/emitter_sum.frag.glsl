// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The sum over one batch of rays from each patch (a fragment each) to places that shine.
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
    color += weights[ray % PATCH_POINTS] * texelFetch(links, texel_of_ray(place, ray), 0);
  }
}
