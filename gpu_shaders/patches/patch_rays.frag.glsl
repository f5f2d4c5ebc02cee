// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where rays from the points of patches get to, RAYS_AT_ONCE for each patch, a fragment each: as a step
// of paths. With EMITTERS to places that shine.
#include "rays/ray_walk.glsl"
#include "rays/ray_surface.glsl"
#include "patches/batch.glsl"
#include "patches/patch_points.glsl"
#include "gather/directions.glsl"
#include "gather/write_surface.glsl"
#include "paths/path_state.glsl"
#include "common/hash.glsl"
#ifdef EMITTERS
#include "gather/emitter_density.glsl"
#include "gather/emitters.glsl"
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 asked = ray_of_texel(pixel);
  int place = asked.x;
  int ray = asked.y;
  write_no_surface(vec3(0.0));
  way_out = vec4(0.0);
  if (place >= patches) {
    return;
  }
  int point = ray % PATCH_POINTS;
  vec3 origin = patch_place(place, point);
  vec3 normal = patch_normal(place, point);
  // A sequence that spreads evenly (Roberts 2018), moved by an amount of the patch's own.
  uint seed = hashed(uint(place) + 1u);
  vec2 moved = vec2(float(seed >> 16u), float(seed & 65535u)) / 65536.0;
  vec2 random = fract(moved + float(batch * RAYS_AT_ONCE + ray) * vec2(0.7548776662, 0.5698402910));
  float farthest = 3e38;
#ifdef EMITTERS
  float choice = fract(float(seed & 4095u) / 4096.0 + float(batch * RAYS_AT_ONCE + ray) * 0.6180339887);
  EmitterPlace shining = emitter_place(vec3(random, choice));
  vec3 away = shining.position - origin;
  farthest = length(away);
  vec3 direction = away / max(farthest, 1e-20);
  float density = emitter_density(shining.density, farthest, dot(shining.normal, direction));
  // Irradiance over radiance, with the rays over the hemisphere, of which there are as many (the balance heuristic).
  float cosine = max(dot(normal, direction), 0.0);
  float strength = cosine / (density + cosine / PI);
#ifdef LIGHTING_SHADOWS_LINKED
  walk_blockers = shining.blocked_by;
  strength = walk_blockers == EVERY_SET ? strength : cosine / density;
#endif
  farthest *= 1.0001;
  if (strength <= 0.0) {
    return;
  }
#else
  vec3 direction = surface_frame(normal, normal) * cosine_direction(random);
  float strength = 0.0;
#endif
  Hit hit = walk(origin, direction, farthest, SEEN_BY_DIFFUSE, 0.0, false);
#ifdef EMITTERS
  // (What is before the place may shine, too: it has chances of its own.)
  strength *= hit.range > 0.999 * farthest ? 1.0 : 0.0;
#endif
  way_out = pack_way(direction, strength, hit.range);
  if (hit.instance < 0) {
    return;
  }
  RaySurface surface = surface_of_hit(hit, origin, direction);
  bool is_within = surface.is_back && fetch_record(solids, int(fetch_record(rays, hit.instance + 5).w)).x > 0.5;
#ifdef LIGHTING_LINKED
  set_on_leaving = patch_set(place, point);
#endif
  write_surface(hit, surface);
#ifndef EMITTERS
  way_out.z = is_within ? 1.0 : 0.0;
#endif
}
