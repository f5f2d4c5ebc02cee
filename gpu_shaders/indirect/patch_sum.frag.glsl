// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// All light at each patch (a fragment each): what lamps and the world send straight there, the mean over its points
// that are not inside of something; and what has come from other surfaces.
#include "common/records.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int place = (pixel.y << ROW_BITS) + pixel.x;
  vec4 swept = texelFetch(patch_swept, pixel, 0);
  vec3 arriving = swept.w > 0.0 ? swept.rgb / swept.w : vec3(0.0);
  vec3 direct = vec3(0.0);
  float all = 0.0;
  if (place < patches) {
    for (int point = 0; point < PATCH_POINTS; point++) {
      float counts = 0.0;
      for (int ray = point; ray < RAYS_AT_ONCE; ray += PATCH_POINTS) {
        int number = place * RAYS_AT_ONCE + ray;
        counts += texelFetch(links, ivec2(number % PICTURE_WIDTH, number / PICTURE_WIDTH), 0).x > -1.5 ? 1.0 : 0.0;
      }
      direct += counts * fetch_record(patch_direct, place * PATCH_POINTS + point).rgb;
      all += counts;
    }
  }
  sent_out = vec4(arriving + (all > 0.0 ? direct / all : vec3(0.0)), 1.0);
  arriving_out = vec4(arriving, 1.0);
}
