// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What one program makes of the surfaces that rays have hit: base color, normal and the other buffers that the scene's
// programs fill. Goes behind the program. `turn`: numbers of the sub-frame and of the bounce. With OF_PATHS of
// a step of paths, with IS_GATHERED of rays for light between surfaces, else of rays from mirror to mirror; with
// AT_ONCE each of these has met its own number of surfaces.
#include "rays/ray_walk.glsl"
#include "rays/ray_surface.glsl"
#include "surfaces/material_at.glsl"
#include "surfaces/fill_buffers.glsl"
#include "programs/chance.glsl"
#include "paths/path_state.glsl"

vec3 to_world_of(Hit hit, vec3 direction)
{
  // The inverse of the rows from world to object space, by its adjugate.
  vec3 x = fetch_record(rays, hit.instance).xyz;
  vec3 y = fetch_record(rays, hit.instance + 1).xyz;
  vec3 z = fetch_record(rays, hit.instance + 2).xyz;
  return (direction.x * cross(y, z) + direction.y * cross(z, x) + direction.z * cross(x, y)) / dot(x, cross(y, z));
}

// Changes of the second and third corner's weights along a way on the triangle.
vec2 weights_along(vec3 way, vec3 ab, vec3 ac)
{
  vec3 facing = cross(ab, ac);
  float area2 = max(dot(facing, facing), 1e-38);
  return vec2(dot(cross(way, ac), facing), dot(cross(ab, way), facing)) / area2;
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 place = texelFetch(vertex_position, pixel, 0);
#ifdef IS_GATHERED
  vec4 path = texelFetch(path_way, pixel, 0);
  vec3 direction = way_direction(path);
  float range = path.w;
#else
  vec4 before = texelFetch(before_position, pixel, 0);
  vec3 way = place.xyz - before.xyz;
  float range = length(way);
#endif
#ifdef OF_PATHS
  vec3 direction = way_direction(texelFetch(path_way, pixel, 0));
  PathState state = unpack_state(texelFetch(path_throughput, pixel, 0).w);
#elif !defined(IS_GATHERED)
  vec3 direction = way / max(range, 1e-30);
#endif
  Hit hit = unpacked_hit(texelFetch(path_hit, pixel, 0));
  RaySurface surface = surface_of_hit(hit, place.xyz, direction);
  vec4 held = fetch_record(materials, MATERIAL_RECORDS * surface.material + 10);
  vec3 ab = to_world_of(hit, fetch_record(rays, hit.triangle + 1).xyz);
  vec3 ac = to_world_of(hit, fetch_record(rays, hit.triangle + 2).xyz);
  ShadingPoint s;
  ivec2 turn_here = turn;
  s.position = place.xyz;
  s.origin = fetch_record(program_records, 0).xyz;
  s.normal = surface.normal;
  s.true_normal = normalize(cross(ab, ac));
  s.true_normal *= dot(s.true_normal, direction) > 0.0 ? -1.0 : 1.0;
  s.incoming = -direction;
  s.is_back = surface.is_back;
  s.instance = row_of_instance(hit.instance);
  s.parametric = hit.place;
  s.ray_length = range;
#ifdef IS_GATHERED
  s.ray = RAY_IS_DIFFUSE | RAY_IS_REFLECTION;
  s.depths = vec3(2.0, 1.0, 1.0);
  s.more_depths = vec2(0.0);
#elif defined(OF_PATHS)
  s.ray = state.kind == RAY_CAMERA ? RAY_IS_CAMERA :
          (RAY_IS_GLOSSY | RAY_IS_SINGULAR | (state.kind == RAY_REFLECTED ? RAY_IS_REFLECTION : RAY_IS_TRANSMISSION));
  s.depths = vec3(float(state.reflected + state.transmitted), 0.0, float(state.reflected));
  s.more_depths = vec2(float(state.transmitted), float(state.passed));
#else
  s.ray = RAY_IS_GLOSSY | RAY_IS_SINGULAR | RAY_IS_REFLECTION;
#ifdef AT_ONCE
  turn_here.y = int(before.w + 0.5);
#endif
  s.depths = vec3(float(turn_here.y), 0.0, float(turn_here.y));
  s.more_depths = vec2(0.0);
#endif
  s.random = chance_at(uvec2(pixel), turn_here);
  s.records = int(held.z + 0.5);
  vec3 weights = vec3(1.0 - hit.place.x - hit.place.y, hit.place);
  s.attributes[ATTRIBUTES] = vec4(0.0);
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes[k] = hit_attribute(hit.instance, hit.triangle, weights, attribute_number(s, k));
  }
#ifdef PROGRAM_BUMP
  float width = 2.0 / (abs(view.view_to_clip[1][1]) * float(textureSize(vertex_position, 0).y));
  width *= view.eye.w > 0.0 ? max(range, distance(place.xyz, view.eye.xyz / view.eye.w)) : 1.0;
  vec3 aside = normalize(abs(s.true_normal.z) < 0.7 ? cross(s.true_normal, vec3(0.0, 0.0, 1.0)) :
                         cross(s.true_normal, vec3(1.0, 0.0, 0.0)));
  s.position_across = width * aside;
  s.position_up = width * cross(s.true_normal, aside);
  vec2 across = weights_along(s.position_across, ab, ac);
  vec2 up = weights_along(s.position_up, ab, ac);
  vec3 weights_across = vec3(-across.x - across.y, across);
  vec3 weights_up = vec3(-up.x - up.y, up);
  s.attributes_across[ATTRIBUTES] = s.attributes_up[ATTRIBUTES] = vec4(0.0);
  for (int k = 0; k < ATTRIBUTES; k++) {
    int number = attribute_number(s, k);
    s.attributes_across[k] = hit_attribute(hit.instance, hit.triangle, weights_across, number);
    s.attributes_up[k] = hit_attribute(hit.instance, hit.triangle, weights_up, number);
  }
#endif
  Material m = material_constants(surface.material);
  m.normal = s.normal;
  material_program(s, m);
  bool is_seen_through = fetch_record(materials, MATERIAL_RECORDS * surface.material + 6).w > 0.5;
#ifdef AT_ONCE
  float shows = before.w > 1.5 ? 1.0 : 0.0;
#else
  float shows = surface.mirror;
#endif
  float facing = 0.0;
#ifdef OF_PATHS
  shows = shows > 0.5 ? shows : (is_seen_through ? SEEN_THROUGH : -1.0);
  facing = surface.is_back ? 0.25 : 0.0;
#else
  is_seen_through = false;
#endif
  vec3 normal = m.normal;
  if (surface.mirror > 0.5 || is_seen_through) {
    normal = reflecting_outward(s.true_normal, s.incoming, normal);
  }
  surface_normal = vec4(normal, float(surface.material) + facing);
  surface_color_out = vec4(m.base_color, shows);
  fill_buffers(m);
}
