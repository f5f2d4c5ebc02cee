// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light for every pixel of one class: of the surface or background seen there or, on a mirror, of what the mirror
// shows. A variant for each class, as many drivers run all branches of a pixel group. One of SHADES_BACKGROUND,
// SHADES_SURFACE, SHADES_MIRROR, SHADES_MIRROR_OF_SURFACE, SHADES_MIRROR_OF_MIRROR and ENVIRONMENT is defined. With
// MIRRORS_END surfaces that mirrors show have their own light alone. With SEEN_BY_MIRROR what sees all this is no
// camera but a mirror. With NO_QUADS each pixel looks up all directions of the sky.
#if (defined(SHADES_SURFACE) || defined(SHADES_MIRROR_OF_SURFACE)) && !defined(SKY_GATHERED) && !defined(NO_QUADS)
#define QUADS
#endif
#include "lighting/quad.glsl"
#include "lighting/lighting.glsl"
#include "lighting/shade_surfaces.glsl"
#include "lighting/mirror_tint.glsl"
#ifdef GATHER_SHARED
#ifdef SHADES_SURFACE
#define SHARED_POSITION seen_position
#define SHARED_NORMAL seen_normal
#else
#define SHARED_POSITION reflected_position
#define SHARED_NORMAL reflected_normal
#endif
#include "gather/shared_gather.glsl"
#endif
#ifdef SEEN_BY_MIRROR
#define BY_CAMERA false
#else
#define BY_CAMERA true
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 origin, direction;
  pixel_ray(textureSize(seen_position, 0), origin, direction);
#ifdef SHADES_BACKGROUND
#ifdef FILM_TRANSPARENT
  // As in Cycles: lamps add their light and cover nothing.
  color = vec4(lamps_seen(origin, direction, 2e30, BY_CAMERA).rgb, 0.0) * weight;
  return;
#endif
  vec3 radiance = world_seen(direction, BY_CAMERA) + lamps_seen(origin, direction, 2e30, BY_CAMERA).rgb;
#else
  vec4 position = texelFetch(seen_position, pixel, 0);
  vec4 normal = texelFetch(seen_normal, pixel, 0);
  vec4 base = texelFetch(seen_color, pixel, 0);
#ifdef SHADES_SURFACE
#ifdef QUADS
  world_is_shared = quad_is_one_surface(position.xyz, normal.xyz, vec3(position.w, normal.w, 0.0));
#endif
  Surface seen = surface_of(pixel, position, normal, base.rgb);
  vec3 radiance = shade_surface(seen, -direction);
#ifdef GATHER_SHARED
  radiance += shared_rays(pixel, position, normal.xyz, seen, -direction);
#endif
#else
#ifdef ENVIRONMENT
  // One pass per mirror.
  if (base.w != mirror) {
    discard;
  }
#endif
  vec3 tint = mirror_tint(int(normal.w + 0.5), base.rgb, max(-dot(normal.xyz, direction), 0.0));
  float seen_mirror = base.w;
#ifdef LIGHTING_LINKED
  lamps_met_from = light_set_of(material_number(normal.w));
#endif
  origin = position.xyz;
  direction = reflect(direction, normal.xyz);
#ifdef ENVIRONMENT
  vec3 radiance = tint * environment_at(origin, direction).rgb;
#endif
#ifdef SHADES_MIRROR
  vec3 radiance = tint * (world_seen(direction, false) + lamps_seen(origin, direction, 2e30, false).rgb);
#endif
#if defined(SHADES_MIRROR_OF_SURFACE) || defined(SHADES_MIRROR_OF_MIRROR)
  position = texelFetch(reflected_position, pixel, 0);
  normal = texelFetch(reflected_normal, pixel, 0);
  base = texelFetch(reflected_color, pixel, 0);
  // What is shown stands where it is, not where this pixel's own ray would have met it.
  direction = normalize(position.xyz - origin);
  Surface shown = surface_of(pixel, position, normal, base.rgb);
#ifdef LIGHTING_CLAMPED
  clamped_way = tint;
#endif
#ifdef LIGHTING_LINKED
  shown = shining_on(shown, lamps_met_from);
#endif
#if defined(MIRRORS_END)
  vec3 radiance = shown.emission;
#elif defined(SHADES_MIRROR_OF_MIRROR)
  // What is seen in that one comes in passes of its own.
  vec3 radiance = shade_under_mirror(shown, -direction);
#else
#ifdef QUADS
  float shown_by = seen_mirror;
#ifdef WHOLE_PATHS
  // Pixels beside may show it by way of another mirror.
  shown_by += 0.25 * base.w;
#endif
  world_is_shared = quad_is_one_surface(shown.position, shown.normal, vec3(position.w, normal.w, shown_by));
#endif
  vec3 radiance = shade_surface(shown, -direction);
#ifdef GATHER_SHARED
  radiance += shared_rays(pixel, position, normal.xyz, shown, -direction);
#endif
#endif
#ifdef LIGHTING_NEAR_LAMPS
  radiance += lamps_seen(origin, direction, distance(position.xyz, origin), false).rgb;
#endif
  radiance *= tint;
#endif
#endif
#endif
  color = vec4(radiance, 1.0) * weight;
}
