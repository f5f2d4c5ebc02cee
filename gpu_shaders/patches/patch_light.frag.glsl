// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What lamps, or with OF_SKY the world, let arrive at each point of each patch (a fragment each), of one sub-frame:
// irradiance.
#include "lighting/lighting.glsl"
#include "patches/patch_points.glsl"
#include "patches/white_surface.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int number = (pixel.y << ROW_BITS) + pixel.x;
  int place = number / PATCH_POINTS;
  color = vec4(0.0);
  if (place >= patches) {
    return;
  }
  int point = number - place * PATCH_POINTS;
  Surface s = white_surface(patch_place(place, point), patch_normal(place, point));
#ifdef LIGHTING_LINKED
  s.light_set = patch_set(place, point);
#endif
  Lobes lobes = base_lobes(s, vec3(1.0), 1.0);
#ifdef OF_SKY
  vec3 radiance = world_on(s, lobes, s.normal);
#else
  vec3 radiance = lamps_on(s, lobes, s.normal);
#endif
  color = vec4(LIGHTING_PI * radiance, 1.0) * weight;
}
