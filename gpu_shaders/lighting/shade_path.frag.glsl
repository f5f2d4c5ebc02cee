// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light of what a ray off a mirror seen in a mirror has hit (exact.frag.glsl), times the mirrors' reflectance on its
// way. With GOES_ON a mirror that was hit adds only its own light, as the ray goes on from it in the next pass.
// With MIRRORS_END all that was hit does. With AT_ONCE rays have gone on to their ends in one pass: drawn where there
// were several mirrors, the first of which the eye sees; what was met last of `most_hits` has its own light alone.
#include "lighting/lighting.glsl"
#include "lighting/shade_surfaces.glsl"
#ifdef AT_ONCE
#include "lighting/mirror_tint.glsl"
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(reflected_position, pixel, 0);
  vec3 radiance = vec3(0.0);
  vec3 throughput = texelFetch(path_throughput, pixel, 0).rgb;
#ifdef AT_ONCE
  vec4 origin = texelFetch(before_position, pixel, 0);
  vec3 direction = position.w == 0.0 ? position.xyz : normalize(position.xyz - origin.xyz);
  vec4 seen = texelFetch(seen_normal, pixel, 0);
  vec3 eye, to_mirror;
  pixel_ray(textureSize(seen_normal, 0), eye, to_mirror);
  vec3 base_color = texelFetch(seen_color, pixel, 0).rgb;
  throughput *= mirror_tint(int(seen.w + 0.5), base_color, max(-dot(seen.xyz, to_mirror), 0.0));
#else
  vec4 origin = texelFetch(mirror_position, pixel, 0);
  vec3 direction = texelFetch(path_direction, pixel, 0).xyz;
#endif
  float range = distance(position.xyz, origin.xyz);
#ifdef LIGHTING_CLAMPED
  clamped_way = throughput;
#endif
#ifdef LIGHTING_LINKED
  lamps_met_from = set_on_way(position, texelFetch(reflected_normal, pixel, 0));
#endif
  if (position.w == 0.0) {
    range = 2e30;
    radiance = world_seen(direction, false);
  }
  else {
    vec4 base = texelFetch(reflected_color, pixel, 0);
    Surface surface = surface_of(pixel, position, texelFetch(reflected_normal, pixel, 0), base.rgb);
#ifdef LIGHTING_LINKED
    surface = shining_on(surface, lamps_met_from);
#endif
#if defined(MIRRORS_END)
    radiance = surface.emission;
#elif defined(AT_ONCE)
    radiance = origin.w > most_hits - 0.5 ? surface.emission : shade_surface(surface, -direction);
#elif defined(GOES_ON)
    if (base.w > 0.5) {
      radiance = shade_under_mirror(surface, -direction);
    }
    else {
      radiance = shade_surface(surface, -direction);
    }
#else
    radiance = shade_surface(surface, -direction);
#endif
  }
  radiance += lamps_seen(origin.xyz, direction, range, false).rgb;
#ifdef AT_ONCE
  color = vec4(throughput * radiance, 1.0) * weight;
#else
  // (The picture's alpha has come with the first mirror.)
  color = vec4(throughput * radiance * weight, 0.0);
#endif
}
