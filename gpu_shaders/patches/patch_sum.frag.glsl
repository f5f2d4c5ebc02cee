// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// All light at each patch (a fragment each): what lamps and the world send straight there, the mean over its points
// that are not inside of something; and what has come from other surfaces.
#include "common/records.glsl"
#include "patches/point_weight.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int place = (pixel.y << ROW_BITS) + pixel.x;
  vec4 swept = texelFetch(patch_swept, pixel, 0);
  vec3 arriving = swept.w > 0.0 ? swept.rgb / swept.w : vec3(0.0);
  vec3 of_lamps = vec3(0.0), of_sky = vec3(0.0);
  float all = 0.0;
  if (place < patches) {
    vec4 weights = weights_of_points(texelFetch(point_weights, pixel, 0));
    for (int point = 0; point < PATCH_POINTS; point++) {
      of_lamps += weights[point] * fetch_record(patch_lamps, place * PATCH_POINTS + point).rgb;
      of_sky += weights[point] * fetch_record(patch_sky, place * PATCH_POINTS + point).rgb;
      all += weights[point];
    }
  }
#ifdef EMITTERS
  vec4 shone = texelFetch(patch_shone, pixel, 0);
  arriving += shone.w > 0.0 ? shone.rgb / shone.w : vec3(0.0);
#endif
  float scale = all > 0.0 ? 1.0 / all : 0.0;
  arriving_out = vec4(arriving, 1.0);
  under_sky_out = vec4(arriving + scale * of_sky, 1.0);
  sent_out = vec4(arriving + scale * (of_sky + of_lamps), 1.0);
}
