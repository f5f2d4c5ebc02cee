// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a ray from a patch has found of what shines: irradiance. With OF_HEMISPHERE one of those over the hemisphere,
// else one of those to places that shine.
#include "surfaces/material_at.glsl"
#include "surfaces/material_number.glsl"
#include "paths/path_state.glsl"
#include "scattering/frame.glsl"
#ifdef OF_HEMISPHERE
#include "patches/batch.glsl"
#include "patches/patch_points.glsl"
#include "gather/emitter_density.glsl"
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 radiance = vec3(0.0);
  vec4 way = texelFetch(path_way, pixel, 0);
  float strength = way.z;
  if (texelFetch(vertex_position, pixel, 0).w > 0.5) {
    vec4 normal = texelFetch(vertex_normal, pixel, 0);
    int material = material_number(normal.w);
    Material m = material_at(pixel, material, vec3(0.0));
    radiance = m.emission;
#ifdef LIGHTING_LINKED
    radiance *= is_for_set(m.shines_on, set_on_way(texelFetch(vertex_position, pixel, 0), normal)) ? 1.0 : 0.0;
#endif
#ifdef OF_HEMISPHERE
    ivec2 asked = ray_of_texel(pixel);
    vec3 from = patch_normal(asked.x, asked.y % PATCH_POINTS);
    float over_area = fetch_record(shining, material).x;
    vec3 direction = way_direction(way);
    float own = max(dot(from, direction), 0.0) / PI;
    float found = emitter_density(over_area, way.w, dot(normal.xyz, direction));
    strength = way.z > 0.5 ? 0.0 : PI * own / max(own + found, 1e-20);
#ifdef LIGHTING_SHADOWS_LINKED
    strength *= fetch_record(shining, material).y > 0.5 ? 0.0 : 1.0;
#endif
#endif
  }
  // (Both kinds of rays count: each stands for the other as well.)
  link_out = vec4(2.0 * radiance * strength, 1.0);
}
