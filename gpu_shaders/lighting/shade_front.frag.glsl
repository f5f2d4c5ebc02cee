// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What adds to the shade pass in some scenes only: with MIRROR_BASE the diffuse base of mirrors that are not metal,
// and lamps seen before surfaces.
#include "lighting/lighting.glsl"
#include "lighting/shade_surfaces.glsl"
#ifdef SEEN_BY_MIRROR
#define BY_CAMERA false
#else
#define BY_CAMERA true
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(seen_position, pixel, 0);
  vec3 origin, direction;
  pixel_ray(textureSize(seen_position, 0), origin, direction);
  vec3 radiance = lamps_seen(origin, direction, distance(position.xyz, origin), BY_CAMERA).rgb;
#ifdef MIRROR_BASE
  vec4 normal = texelFetch(seen_normal, pixel, 0);
  vec4 base = texelFetch(seen_color, pixel, 0);
  radiance += shade_under_mirror(surface_of(pixel, position, normal, base.rgb), -direction);
#endif
  color = vec4(radiance * weight, 0.0);
}
