// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light that a ray between surfaces brings. One of LIGHTS_BASE_MEETS (a ray off a base has met a surface: the light
// of its patch), LIGHTS_LOBE_MEETS (a ray off a lobe has: lit as what mirrors show) and LIGHTS_LOBE_MISSES (the world)
// is defined.
#include "lighting/lighting.glsl"
#include "lighting/shade_surfaces.glsl"
#include "indirect/cells.glsl"
#include "indirect/sent_on.glsl"
#include "paths/path_state.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 way = texelFetch(path_way, pixel, 0);
  vec3 direction = way_direction(way);
  vec3 radiance = vec3(0.0);
#ifdef LIGHTS_LOBE_MISSES
  radiance = world_met(direction, false, 1.0);
#else
  vec4 position = texelFetch(vertex_position, pixel, 0);
  vec4 normal = texelFetch(vertex_normal, pixel, 0);
  vec3 base = texelFetch(vertex_color, pixel, 0).rgb;
#ifdef LIGHTS_BASE_MEETS
  int place = patch_at(position.xyz, normal.xyz);
  if (place >= 0) {
    Material m = material_at(pixel, material_number(normal.w), base);
    radiance = sent_on(m, normal.xyz, direction) * fetch_record(patch_light, place).rgb / LIGHTING_PI;
  }
#else
  radiance = shade_surface(surface_of(pixel, position, normal, base), -direction);
#endif
#endif
  color = vec4(texelFetch(gather_weight, pixel, 0).rgb * radiance * weight, 0.0);
}
