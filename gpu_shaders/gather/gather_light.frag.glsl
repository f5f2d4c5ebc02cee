// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light that a ray between surfaces brings. One of LIGHTS_BASE_MEETS (a ray off a base has met a surface: the light
// of its patch), LIGHTS_LOBE_MEETS (one off a lobe has: lit as what mirrors show), LIGHTS_SHINES (a ray has gone to a
// place that shines), LIGHTS_BASE_MISSES and LIGHTS_LOBE_MISSES (the world) is defined. With EMITTERS what shines by
// itself counts together with the rays that go there (the balance heuristic).
#include "lighting/lighting.glsl"
#include "lighting/shade_surfaces.glsl"
#include "patches/cells.glsl"
#include "gather/sent_on.glsl"
#include "paths/path_state.glsl"
#include "patches/white_surface.glsl"
#ifdef EMITTERS
#include "gather/emitter_density.glsl"
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 way = texelFetch(path_way, pixel, 0);
  vec3 direction = way_direction(way);
  vec3 radiance = vec3(0.0);
#if defined(LIGHTS_LOBE_MISSES)
  radiance = world_met(direction, false, 1.0);
#elif defined(LIGHTS_BASE_MISSES)
  radiance = world_met(direction, false, 1.0);
#ifdef LIGHTING_PARTS
  radiance = lighting_data[6].z > 0.5 ? radiance * lighting_data[6].y : world_radiance(direction) * lighting_data[6].y;
#endif
#else
  vec4 position = texelFetch(vertex_position, pixel, 0);
  vec4 normal = texelFetch(vertex_normal, pixel, 0);
  vec3 base = texelFetch(vertex_color, pixel, 0).rgb;
  int material = material_number(normal.w);
  Material m = material_at(pixel, material, base);
#if defined(LIGHTS_BASE_MEETS) && !defined(DIRECT_ALONE)
  vec3 side = normal.xyz, of_lamps;
  vec3 sent = sent_on(m, fract(way.x * 517.31 + way.y * 389.17), direction, side, of_lamps);
  int place = patch_at(position.xyz, side);
  if (place >= 0) {
    radiance = sent * fetch_record(patch_light, place).rgb / LIGHTING_PI;
  }
#ifdef LIGHTING_LAMPS
  // (Edges of lamps' shadows are finer than patches.)
  Surface met = white_surface(position.xyz, side);
#ifdef LIGHTING_LINKED
  met.light_set = m.light_set;
#endif
  radiance += of_lamps * lamps_on(met, base_lobes(met, vec3(1.0), 1.0), side);
#endif
#elif defined(LIGHTS_LOBE_MEETS) && !defined(DIRECT_ALONE)
  Surface s = surface_of(pixel, position, normal, base);
  s.emission = vec3(0.0);
  // As Cycles' Filter Glossy, by its default: behind a wide lobe narrow ones are wider.
  float blurred = way.z > 0.0 ? 0.5 * sqrt(max(1.0 - way.z, 0.0)) : 0.0;
  s.roughness = max(s.roughness, sqrt(blurred));
  radiance = shade_surface(s, -direction);
#endif
#ifndef LIGHTS_SHINES
  // As Cycles clamps what has bounced.
  float most = clamp_most / max(largest(texelFetch(gather_weight, pixel, 0).rgb), 1e-9);
  radiance *= min(1.0, most / max(mean_of(radiance), 1e-9));
#endif
#ifdef EMITTERS
  float share = 1.0;
#ifndef LIGHTS_SHINES
  if (way.z > 0.0) {
    float over_area = fetch_record(shining, material).x;
    float found = EMITTER_SHARE * emitter_density(over_area, way.w, dot(normal.xyz, direction));
    float own = (1.0 - EMITTER_SHARE) * way.z;
    share = own / (own + found);
#ifdef LIGHTING_SHADOWS_LINKED
    share *= fetch_record(shining, material).y > 0.5 ? 0.0 : 1.0;
#endif
  }
#endif
#ifdef LIGHTING_LINKED
  share *= is_for_set(m.shines_on, set_on_way(position, normal)) ? 1.0 : 0.0;
#endif
  radiance += share * m.emission;
#endif
#endif
  vec4 held = texelFetch(gather_weight, pixel, 0);
#ifdef IS_SHARED
  color = vec4(held.rgb * radiance, held.w);
#else
  color = vec4(held.rgb * radiance * weight, 0.0);
#endif
}
