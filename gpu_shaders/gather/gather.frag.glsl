// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// One ray for the light that other surfaces send to what a pixel shows: off its base, by the cosine, or off the lobe
// above. One of OF_SEEN (what the eye sees itself), OF_SHOWN (what a mirror shows first), OF_LATER (what rays off
// later mirrors have hit) and OF_PATHS (where a path stops) says which buffers that is. gather_weight: what the ray's
// light is multiplied by; w: its kind (ray_kinds.glsl). With EMITTERS one ray in two goes to a place that shines;
// way.z is the density of a ray off base or lobe to where it went, over the share of such rays that are not sharp.
#include "lighting/ggx.glsl"
#include "rays/ray_walk.glsl"
#include "rays/ray_surface.glsl"
#include "lighting/shade_surfaces.glsl"
#include "lighting/mirror_tint.glsl"
#include "scattering/microfacet.glsl"
#include "gather/directions.glsl"
#include "gather/followed_value.glsl"
#include "gather/ray_kinds.glsl"
#include "gather/write_surface.glsl"
#ifdef EMITTERS
#include "gather/emitter_density.glsl"
#include "gather/emitters.glsl"
#endif
#include "paths/path_state.glsl"
#include "paths/random.glsl"

// Of a ray off base and lobe to a direction in the frame of the normal.
float ray_density(Lobes lobes, float through, float chance, vec3 viewer, vec3 light)
{
  float sum = (1.0 - chance) * (light.z > 0.0 ? 1.0 - through : through) * abs(light.z) / PI;
  if (light.z > 0.0 && chance > 0.0 && lobes.alpha > GGX_SINGULAR_ALPHA) {
    vec2 alpha = vec2(lobes.alpha);
    sum += chance * reflected_density(viewer, normalize(viewer + light), alpha, cap_bound(viewer, alpha));
  }
  return sum;
}

void main()
{
#ifdef SHARED_BY_QUADS
  // (Of each quad of pixels one asks for all four: shared_gather.glsl.)
  ivec2 pixel = min(2 * ivec2(gl_FragCoord.xy) + lane, textureSize(vertex_position, 0) - 1);
#else
  ivec2 pixel = ivec2(gl_FragCoord.xy);
#endif
  vec4 place = texelFetch(vertex_position, pixel, 0);
  vec4 facing = texelFetch(vertex_normal, pixel, 0);
  Surface s = surface_of(pixel, place, facing, texelFetch(vertex_color, pixel, 0).rgb);
  vec3 throughput = vec3(1.0);
#ifdef OF_SEEN
  vec3 incoming = normalize(s.position * view.eye.w - view.eye.xyz);
  float seen = texelFetch(vertex_color, pixel, 0).w;
  throughput *= seen > -1.5 && seen < -0.5 ? 1.0 : 0.0;
#elif defined(OF_SHOWN)
  vec3 mirror_place = texelFetch(mirror_position, pixel, 0).xyz;
  vec4 mirror_facing = texelFetch(mirror_normal, pixel, 0);
  vec3 eye_ray = normalize(mirror_place * view.eye.w - view.eye.xyz);
  throughput = mirror_tint(int(mirror_facing.w + 0.5), texelFetch(mirror_color, pixel, 0).rgb,
                           max(-dot(mirror_facing.xyz, eye_ray), 0.0));
  vec3 incoming = normalize(s.position - mirror_place);
#elif defined(OF_LATER)
  vec3 incoming = texelFetch(path_direction, pixel, 0).xyz;
  throughput = texelFetch(path_throughput, pixel, 0).rgb;
  bool goes_on = skips_mirrors > 0.5 && texelFetch(vertex_color, pixel, 0).w > 0.5;
  throughput *= place.w == 0.0 || goes_on ? 0.0 : 1.0;
#else
  vec3 incoming = way_direction(texelFetch(path_way, pixel, 0));
  vec4 state = texelFetch(path_throughput, pixel, 0);
  throughput = unpack_state(state.w).ends ? vec3(0.0) : state.rgb;
#endif
  Lobes lobes = lobes_of(s, -dot(s.normal, incoming));
  vec4 random = path_random(pixel);
  float of_base = mean_of(lobes.diffuse);
  float of_lobe = mean_of(lobes.specular_albedo);
  float through = 0.0;
#ifdef SURFACE_TRANSLUCENT
  through = mean_of(lobes.translucent);
  of_base += through;
  through /= max(of_base, 1e-9);
#endif
  // (By the roots: what a lobe shows may be far brighter than what the base scatters.)
  float chance = of_lobe > 0.0 ? sqrt(of_lobe) / max(sqrt(of_base) + sqrt(of_lobe), 1e-9) : 0.0;
  bool is_lobe = random.z < chance;
  mat3 frame = surface_frame(s.normal, s.normal);
  vec3 direction;
  float density = 0.0;
  float inverse_chance;
  vec3 weight;
  vec3 viewer = viewer_in(frame, -incoming);
  float kind = is_lobe ? RAY_OFF_LOBE : RAY_OFF_BASE;
  vec3 start = off_surface(s.position, s.normal);
  float farthest = 3e38;
#ifdef SURFACE_TRANSLUCENT
  vec3 below = 2.0 * s.position - start;
#endif
#ifdef EMITTERS
  if (random.w < EMITTER_SHARE) {
    EmitterPlace shining = emitter_place(vec3(random.xy, random.w / EMITTER_SHARE));
    vec3 away = shining.position - start;
    farthest = length(away);
    direction = away / max(farthest, 1e-20);
    vec3 light = direction * frame;
    density = ray_density(lobes, through, chance, viewer, light);
    float found = emitter_density(shining.density, farthest, dot(shining.normal, direction));
    weight = light.z > 0.0 ? followed_value(lobes, s.normal, -incoming, direction) : vec3(0.0);
#ifdef SURFACE_TRANSLUCENT
    weight += lobes.translucent * (max(-light.z, 0.0) / PI);
    start = light.z < 0.0 ? below : start;
#endif
    inverse_chance = 1.0 / (EMITTER_SHARE * found + (1.0 - EMITTER_SHARE) * density);
#ifdef LIGHTING_SHADOWS_LINKED
    walk_blockers = shining.blocked_by;
    if (walk_blockers != EVERY_SET) {
      // (Other rays meet what is not in this one's way.)
      inverse_chance = 1.0 / (EMITTER_SHARE * found);
    }
#endif
    weight *= inverse_chance;
    // (It has to be met itself.)
    farthest *= 1.0001;
    is_lobe = false;
    kind = RAY_TO_EMITTER;
  }
  else
#endif
  if (is_lobe) {
    vec3 h = vec3(0.0, 0.0, 1.0);
    if (lobes.alpha > GGX_SINGULAR_ALPHA) {
      vec2 alpha = vec2(lobes.alpha);
      float bound = cap_bound(viewer, alpha);
      h = visible_normal(viewer, alpha, bound, random.xy);
    }
    direction = frame * reflect(-viewer, h);
    inverse_chance = 1.0 / chance;
    weight = lobes.specular_albedo * inverse_chance;
    // (0: sharp.)
    density = lobes.alpha > GGX_SINGULAR_ALPHA ?
      ray_density(lobes, through, chance, viewer, direction * frame) : 0.0;
  }
  else {
    direction = frame * cosine_direction(random.xy);
    inverse_chance = 1.0 / ((1.0 - chance) * (1.0 - through));
    weight = lobes.diffuse * inverse_chance;
#ifdef SURFACE_TRANSLUCENT
    float turned = (random.z - chance) / max(1.0 - chance, 1e-9);
    if (turned < through) {
      direction = -direction;
      start = below;
      inverse_chance = 1.0 / ((1.0 - chance) * through);
      weight = lobes.translucent * inverse_chance;
      kind = RAY_THROUGH;
    }
#endif
    density = ray_density(lobes, through, chance, viewer, direction * frame);
  }
#ifdef EMITTERS
  weight /= kind != RAY_TO_EMITTER ? 1.0 - EMITTER_SHARE : 1.0;
  inverse_chance /= kind != RAY_TO_EMITTER ? 1.0 - EMITTER_SHARE : 1.0;
#endif
  weight *= throughput;
  bool is_asked = largest(throughput) > 0.0;
  bool is_alive = largest(weight) > 0.0 && (start != s.position) && dot(direction, start - s.position) > 0.0;
  int seen_by = is_lobe ? SEEN_IN_MIRRORS : SEEN_BY_DIFFUSE;
  Hit hit = walk(start, direction, is_alive ? farthest : -1.0, seen_by, 0.0, false);
  write_no_surface(start);
  way_out = pack_way(direction, density, hit.range);
#ifdef IS_SHARED
  weight = vec3(inverse_chance);
#endif
#ifdef EMITTERS
  // (What is before the place may shine, too: it has chances of its own.)
  is_alive = is_alive && (kind != RAY_TO_EMITTER || hit.range > 0.999 * farthest);
#endif
  float dark = kind == RAY_TO_EMITTER ? RAY_SHADOWED : RAY_WITHOUT_LIGHT;
  weight_out = is_alive ? vec4(weight, kind) : vec4(vec3(0.0), is_asked ? dark : RAY_NONE);
#ifdef LIGHTING_LINKED
  set_on_leaving = s.light_set;
#endif
  if (hit.instance >= 0) {
    write_surface(hit, surface_of_hit(hit, start, direction));
  }
}
