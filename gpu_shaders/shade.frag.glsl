// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light for every pixel: of the surface seen there or, on a mirror, of what the mirror shows there.
// One call of each lighting function for both: many drivers run all branches of a pixel group.
#include "lighting.glsl"
#include "shade_surfaces.glsl"
#include "mirror_tint.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(seen_position, pixel, 0);
  vec4 normal = texelFetch(seen_normal, pixel, 0);
  vec4 base = texelFetch(seen_color, pixel, 0);
  bool on_mirror = position.w > 0.0 && base.w > 0.5;
#ifdef NO_MIRRORS
  if (on_mirror) {
    discard;
  }
#endif
#ifdef ENVIRONMENT
  // One pass per mirror; the first also does all that is no mirror.
  if ((on_mirror ? base.w : 1.0) != mirror) {
    discard;
  }
#endif
  vec3 origin, direction;
  pixel_ray(textureSize(seen_position, 0), origin, direction);
  vec3 tint = vec3(1.0);
#ifndef NO_MIRRORS
  if (on_mirror) {
    tint = mirror_tint(int(normal.w + 0.5), base.rgb, max(-dot(normal.xyz, direction), 0.0));
    origin = position.xyz;
    direction = reflect(direction, normal.xyz);
#ifndef ENVIRONMENT
    position = texelFetch(reflected_position, pixel, 0);
    normal = texelFetch(reflected_normal, pixel, 0);
    base = texelFetch(reflected_color, pixel, 0);
    // What is shown stands where it is, not where this pixel's own ray would have met it.
    direction = position.w > 0.0 ? normalize(position.xyz - origin) : direction;
#endif
  }
#endif
  vec3 radiance = shade_surface(surface_of(position, normal, base.rgb), -direction);
  float range = distance(position.xyz, origin);
  if (position.w == 0.0) {
    radiance = world_radiance(direction);
    range = 2e30;
  }
  if (on_mirror) {
#ifdef ENVIRONMENT
    radiance = environment_at(origin, direction).rgb;
#else
    radiance += lamps_seen(origin, direction, range).rgb;
#endif
  }
  bool blank = !on_mirror && (is_holdout(normal) || mirrors_only > 0.5);
  color = blank ? vec4(0.0) : vec4(tint * radiance, 1.0) * weight;
}
