// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light that a path finds, times what is left of it on the way. One define says at which pixels: LIGHTS_MISSES (it met
// nothing), LIGHTS_STOPS (a surface where it ends), LIGHTS_GOES_ON (a surface from which it goes on: what that shows
// besides). With ON_PATH what a step has met (step.frag.glsl), else what the eye sees.
#if defined(LIGHTS_STOPS) && defined(LIGHTING_WORLD) && !defined(SKY_GATHERED) && !defined(NO_QUADS)
#define QUADS
#endif
#include "common/hash.glsl"
#include "lighting/quad.glsl"
#include "lighting/lighting.glsl"
#include "lighting/shade_surfaces.glsl"
#include "paths/path_state.glsl"
#ifdef GATHER_SHARED
#define SHARED_POSITION vertex_position
#define SHARED_NORMAL vertex_normal
#include "gather/shared_gather.glsl"
#endif
#ifdef LIGHTS_GOES_ON
#include "paths/vertex_light.glsl"
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(vertex_position, pixel, 0);
  float cover = 0.0;
#ifdef ON_PATH
  vec4 way = texelFetch(path_way, pixel, 0);
  vec4 throughput = texelFetch(path_throughput, pixel, 0);
  PathState state = unpack_state(throughput.w);
  bool by_camera = state.kind == RAY_CAMERA;
  vec3 origin = texelFetch(before_position, pixel, 0).xyz;
  vec3 direction = way_direction(way);
  float density = way.z;
#ifdef LIGHTING_CLAMPED
  clamped_way = state.reflected + state.transmitted > 0 ? throughput.rgb : vec3(0.0);
#endif
#else
  vec3 throughput = vec3(1.0);
  bool by_camera = true;
  float density = 0.0;
  vec3 origin, direction;
  pixel_ray(textureSize(vertex_position, 0), origin, direction);
  cover = 1.0;
#endif
  vec3 radiance = vec3(0.0);
  float range = distance(position.xyz, origin);
#ifdef LIGHTING_LINKED
  lamps_met_from = by_camera ? -1 : set_on_way(position, texelFetch(vertex_normal, pixel, 0));
#endif
#ifdef LIGHTS_MISSES
  range = 2e30;
  bool is_hole = texelFetch(vertex_color, pixel, 0).w == HOLE;
  bool is_open = is_hole;
#ifdef FILM_TRANSPARENT
  is_open = is_open || by_camera;
#endif
  if (is_open) {
    // (What its first surface has covered, but for what has come through.)
    cover = -dot(throughput.rgb, vec3(1.0 / 3.0));
  }
  else {
#ifdef PATH_LIGHT
    radiance = world_met(direction, by_camera, density);
#else
    radiance = world_seen(direction, by_camera);
#endif
  }
#else
  vec4 normal = texelFetch(vertex_normal, pixel, 0);
  vec3 base = texelFetch(vertex_color, pixel, 0).rgb;
#ifdef LIGHTS_STOPS
  Surface surface = surface_of(pixel, position, normal, base);
#ifdef LIGHTING_LINKED
  surface = shining_on(surface, lamps_met_from);
#endif
#ifdef QUADS
  // (Of other pixels a quad may have what an older step has met.)
  float met_now = texelFetch(classes_before, pixel, 0).x;
  world_is_shared = quad_is_one_surface(position.xyz, normal.xyz, vec3(position.w, normal.w, met_now));
  world_is_parted = density > 0.0;
  // (By a hash, as the directions' order has a pattern.)
  ivec2 quad = pixel >> 1;
  uint place = uint(quad.x) * 73856093u ^ uint(quad.y) * 19349663u ^ uint(turn) * 83492791u;
  world_turn = int(hashed(place) >> 24u);
#endif
#ifdef ON_PATH
  radiance = state.ends ? surface.emission : shade_surface(surface, -direction);
#ifdef GATHER_SHARED
  radiance += state.ends ? vec3(0.0) : shared_rays(pixel, position, normal.xyz, surface, -direction);
#endif
#else
  radiance = shade_surface(surface, -direction);
#endif
#else
#ifdef LIGHTING_LINKED
  Surface surface = shining_on(surface_of(pixel, position, normal, base), lamps_met_from);
  radiance = light_of_vertex(surface, vertex_at(pixel), -direction);
#else
  radiance = light_of_vertex(surface_of(pixel, position, normal, base), vertex_at(pixel), -direction);
#endif
#endif
#endif
#if defined(LIGHTS_MISSES) || defined(LIGHTING_NEAR_LAMPS)
  // (Suns are behind all surfaces.)
#ifdef PATH_LIGHT
  ray_density = density;
#endif
#ifdef LIGHTS_MISSES
  range = is_hole ? 0.0 : range;
#endif
  radiance += lamps_seen(origin, direction, range, by_camera).rgb;
#endif
  color = vec4(throughput.rgb * radiance, cover) * weight;
}
