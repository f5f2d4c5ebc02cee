// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a mirror pixel shows: the first surface on the ray that its point and shading normal reflect. With ON_PATH the
// mirror is what the pass before has shown, and the ray goes on from there. Drawn at mirror pixels only (path_mask).
// With KEEPS_WAY the next pass can go on from here. With AT_ONCE there is none: the ray goes on from mirrors here,
// until it has met `most_hits` surfaces, and tells where it set out to the last and how many these were. With
// WITH_COUNTS the direction is (nodes, triangles, instances that the ray was tested against, 1).
#include "rays/ray_walk.glsl"
#include "rays/ray_surface.glsl"
#include "lighting/mirror_tint.glsl"

#ifdef KNOWS_ESCAPES
// Whether a ray off a mirror, by its number, cannot meet that mirror again, by the cones of renderer/rays/escapes.py:
// records `escape_rows` of each mirror (0 where it has none: the first of all is no cone), and `escape_cones` of each
// cell of its mesh (unit axis, least cosine to it).
bool escapes(vec3 origin, vec3 direction, float own)
{
  int first = ESCAPE_ROW_RECORDS * int(own + 0.5);
  vec4 x = fetch_record(escape_rows, first);
  vec4 y = fetch_record(escape_rows, first + 1);
  vec4 z = fetch_record(escape_rows, first + 2);
  int cones = int(fetch_record(escape_rows, first + 3).x + 0.5);
  vec4 start = vec4(origin, 1.0);
  ivec3 cell = ivec3(floor(vec3(dot(x, start), dot(y, start), dot(z, start))));
  cell = clamp(cell, ivec3(0), ivec3(ESCAPE_CELLS - 1));
  vec4 cone = fetch_record(escape_cones, cones + cell.x + ESCAPE_CELLS * (cell.y + ESCAPE_CELLS * cell.z));
  vec3 way = vec3(dot(x.xyz, direction), dot(y.xyz, direction), dot(z.xyz, direction));
  return dot(cone.xyz, way) > cone.w * length(way);
}
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 mirror_place = texelFetch(mirror_position, pixel, 0);
  vec4 mirror_facing = texelFetch(mirror_normal, pixel, 0);
  vec4 mirror_base = texelFetch(mirror_color, pixel, 0);
  float own = mirror_base.w;
#ifdef ON_PATH
  vec3 incoming = texelFetch(path_direction, pixel, 0).xyz;
#else
  vec3 incoming = normalize(mirror_place.xyz * view.eye.w - view.eye.xyz);
#endif
  vec3 normal = mirror_facing.xyz;
  vec3 direction = reflect(incoming, normal);
  // `enclosing`: number of the mirror that holds the eye, how far in rays start, 1 in the last pass. Inside of a
  // mirror rays start a little off its surface, and do not get out.
  bool is_enclosed = abs(own - enclosing.x) < 0.5;
  vec3 origin = is_enclosed ? mirror_place.xyz + enclosing.y * normal : mirror_place.xyz;
#ifdef AT_ONCE
  Hit hit;
  RaySurface surface;
  vec3 tint = vec3(1.0);  // of all mirrors but the first
  float hits = 0.0;
  bool goes_on;
  do {
#ifdef KNOWS_ESCAPES
    walk_escapes = escapes(origin, direction, own);
#endif
    hit = walk(origin, direction, 3e38, SEEN_IN_MIRRORS, own, false);
    hits += 1.0;
    goes_on = false;
    if (hit.instance >= 0) {
      surface = surface_of_hit(hit, origin, direction);
      goes_on = surface.mirror > 0.5 && hits < most_hits;
    }
    if (goes_on) {
      vec3 base = fetch_record(materials, MATERIAL_RECORDS * surface.material + 2).rgb;
      tint *= mirror_tint(surface.material, base, max(-dot(surface.normal, direction), 0.0));
      origin = surface.position;
      direction = reflect(direction, surface.normal);
      own = surface.mirror;
    }
  } while (goes_on);
  before_out = vec4(origin, hits);
  throughput_out = vec4(min(tint, vec3(6e4)), 1.0);
#else
#ifdef KNOWS_ESCAPES
  walk_escapes = escapes(origin, direction, own);
#endif
  Hit hit = walk(origin, direction, 3e38, SEEN_IN_MIRRORS, is_enclosed ? 0.0 : own, false);
#endif

#ifdef KEEPS_WAY
#ifdef WITH_COUNTS
  direction_out = vec4(hit.visited, hit.tested, hit.entered, 1.0);
#else
  direction_out = vec4(direction, hit.visited);
#endif
  vec3 tint = mirror_tint(int(mirror_facing.w + 0.5), mirror_base.rgb, max(-dot(normal, incoming), 0.0));
#ifdef ON_PATH
  tint *= texelFetch(path_throughput, pixel, 0).rgb;
#endif
  // (Half precision ends a little above.)
  throughput_out = vec4(min(tint, vec3(6e4)), 1.0);
#endif
  if (hit.instance < 0) {
    surface_position = vec4(direction, 0.0);
    surface_normal = vec4(0.0);
    surface_color_out = vec4(0.0);
#ifdef AT_ONCE
    surface_color_out.w = hits > 1.5 ? 1.0 : 0.0;
#endif
#ifdef LIGHTING_LINKED
    surface_normal.w = float(light_set_of(int(mirror_facing.w + 0.5)));
#endif
#ifdef WITH_HITS
    hit_out = vec4(0.0);
#endif
    return;
  }
#ifndef AT_ONCE
  RaySurface surface = surface_of_hit(hit, origin, direction);
#endif
#ifdef KEEPS_WAY
  // Nor does light get in, however coarse its shadows are.
  if (is_enclosed && enclosing.z > 0.5 && abs(surface.mirror - enclosing.x) < 0.5) {
    throughput_out.rgb = vec3(0.0);
  }
#endif
  surface_position = vec4(surface.position, surface.object_id);
#ifdef LIGHTING_LINKED
  surface_position.w = with_set(surface.object_id, light_set_of(int(mirror_facing.w + 0.5)));
#endif
  surface_normal = vec4(surface.normal, float(surface.material));
  surface_color_out = vec4(fetch_record(materials, MATERIAL_RECORDS * surface.material + 2).rgb, surface.mirror);
#ifdef AT_ONCE
  surface_color_out.w = hits > 1.5 ? 1.0 : 0.0;
#endif
#ifdef WITH_HITS
  hit_out = packed_hit(hit);
#endif
}
