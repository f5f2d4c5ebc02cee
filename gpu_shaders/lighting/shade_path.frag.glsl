// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light of what a ray off a mirror seen in a mirror has hit (exact.frag.glsl), times the mirrors' reflectance on its
// way. With GOES_ON a mirror that was hit adds only its own light, as the ray goes on from it in the next pass.
// With MIRRORS_END all that was hit does.
#include "lighting/lighting.glsl"
#include "lighting/shade_surfaces.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 origin = texelFetch(mirror_position, pixel, 0);
  vec4 position = texelFetch(reflected_position, pixel, 0);
  vec3 direction = texelFetch(path_direction, pixel, 0).xyz;
  float range = distance(position.xyz, origin.xyz);
  vec3 radiance = vec3(0.0);
  vec3 throughput = texelFetch(path_throughput, pixel, 0).rgb;
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
  // (The picture's alpha has come with the first mirror.)
  color = vec4(throughput * radiance * weight, 0.0);
}
