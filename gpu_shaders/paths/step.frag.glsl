// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// One step of paths: what the surface does that each has met (scatter.glsl), and the next surface on its way. Drawn
// where the class of pixels says that paths go on (path_classes.frag.glsl). With ON_PATH the surface is what the step
// before has found, else what the eye sees. Bounces are counted, and end a path, as in Cycles.
#include "rays/ray_walk.glsl"
#include "rays/ray_surface.glsl"
#include "paths/path_state.glsl"
#include "paths/path_vertex.glsl"
#include "paths/random.glsl"
#ifdef PATHS_ABSORPTION
#include "paths/media.glsl"
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  PathVertex v = vertex_at(pixel);
#ifdef ON_PATH
  vec4 way = texelFetch(path_way, pixel, 0);
  vec3 incoming = way_direction(way);
  vec4 before = texelFetch(path_throughput, pixel, 0);
#else
  vec4 way = vec4(0.0);
  vec3 eye_light = vec3(1.0);
  vec3 incoming = normalize(v.position * view.eye.w - view.eye.xyz);
#ifdef PATHS_ABSORPTION
  if (v.facing.is_back && view.eye.w > 0.0) {
    // The eye is inside.
    way.w = crossed(0.0, medium_of(v.index), true);
    eye_light = exp(-density_of(way.w) * distance(v.position, view.eye.xyz / view.eye.w));
  }
#endif
  vec4 before = vec4(eye_light, float(RAY_CAMERA));
#endif
  PathState state = unpack_state(before.w);
  vec4 random = path_random(pixel);
  Scatter next;
  if (v.follows) {
    next = scatter(v.material, v.facing, -incoming, random);
  }
  else {
    next.kind = random.w >= v.material.alpha ? SCATTER_PASSES : SCATTER_ENDS;
    next.direction = incoming;
    next.weight = v.material.transparent_tint;
    next.pdf = 0.0;
  }
  bool crosses = next.kind == SCATTER_TRANSMITS || next.kind == SCATTER_PASSES;
  // `limits`: reflections, interfaces and transparent surfaces that are followed, and the first two together.
  if (next.kind == SCATTER_REFLECTS) {
    state.kind = RAY_REFLECTED;
    state.reflected++;
  }
  else if (next.kind == SCATTER_TRANSMITS) {
    state.kind = RAY_TRANSMITTED;
    state.transmitted++;
  }
  else {
    state.passed++;
    next.pdf = way.z;
  }
  state.ends = state.reflected > limits.x || state.transmitted > limits.y || state.passed > limits.z ||
               state.reflected + state.transmitted > limits.w;
  vec3 weight = next.kind == SCATTER_ENDS ? vec3(0.0) : next.weight;
  vec3 throughput = before.rgb * weight;
  float media = way.w;
#ifdef PATHS_ABSORPTION
  if (crosses && !v.material.thin_wall) {
    media = crossed(media, medium_of(v.index), !v.facing.is_back);
  }
#endif
  way_out = pack_way(next.direction, next.pdf, media);
#ifdef LIGHTING_LINKED
  // (What goes straight on is still on the way from what it left before.)
  int number = v.material.light_set;
#ifdef ON_PATH
  if (next.kind == SCATTER_PASSES) {
    number = set_on_way(texelFetch(vertex_position, pixel, 0), vec4(0.0));
  }
#endif
#endif
  bool is_alive = max(throughput.r, max(throughput.g, throughput.b)) > 0.0;
  // (See `walk`.)
  own_side = crosses == v.facing.is_back ? 1.0 : -1.0;
  int seen_by = state.kind == RAY_CAMERA ? SEEN_BY_CAMERA :
                (state.kind == RAY_REFLECTED ? SEEN_IN_MIRRORS : SEEN_THROUGH_GLASS);
  Hit hit = walk(v.position, next.direction, is_alive ? 3e38 : -1.0, seen_by, v.object_id, false);
#ifdef PATHS_ABSORPTION
  throughput *= exp(-density_of(media) * (hit.instance < 0 ? 1e30 : hit.range));
#endif
  throughput_out = vec4(throughput, pack_state(state));
  surface_position = vec4(next.direction, 0.0);
  surface_normal = surface_color_out = vec4(0.0);
#ifdef LIGHTING_LINKED
  surface_normal.w = float(number);
#endif
#ifdef WITH_HITS
  hit_out = vec4(0.0);
#endif
  bool is_hole = hit.instance >= 0 && state.kind == RAY_CAMERA &&
                 (int(fetch_record(rays, hit.instance + 3).z) & HOLDS_OUT) != 0;
  if (is_hole) {
    surface_color_out.w = HOLE;
  }
  else if (hit.instance >= 0) {
    RaySurface surface = surface_of_hit(hit, v.position, next.direction);
    vec4 base = fetch_record(materials, MATERIAL_RECORDS * surface.material + 2);
    bool is_seen_through = fetch_record(materials, MATERIAL_RECORDS * surface.material + 6).w > 0.5;
    surface_position = vec4(surface.position, surface.object_id);
#ifdef LIGHTING_LINKED
    surface_position.w = with_set(surface.object_id, number);
#endif
    surface_normal = vec4(surface.normal, float(surface.material) + (surface.is_back ? 0.25 : 0.0));
    float shows = surface.mirror > 0.5 ? surface.mirror : (is_seen_through ? SEEN_THROUGH : -1.0);
    surface_color_out = vec4(base.rgb, shows);
#ifdef WITH_HITS
    hit_out = packed_hit(hit);
#endif
  }
}
