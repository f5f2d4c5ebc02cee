// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light of rays between surfaces that pixels share: those off the base with the texels of `gather_light` about the
// pixel's own whose rays began on the same surface nearby. With SHARED_BY_QUADS a quad of pixels has one texel, whose
// ray began at one of them (`lane`), another one in each sub-frame. With EMITTERS those that went to where light
// comes from are shared as well, where none of them met a shadow. `gather_light`: radiance over the chance of the
// ray; w: its kind. Needs `gather_way`, the push constant `share_turn` (INT: of the sub-frame) and the samplers
// SHARED_POSITION and SHARED_NORMAL of where rays began.
#include "gather/followed_value.glsl"
#include "gather/ray_kinds.glsl"
#include "paths/path_state.glsl"
#include "common/hash.glsl"

// How far off rays are shared in the world, in parts of the way that light comes; how many texels are asked, and how
// far off these are.
#define SHARED_WAY 0.03
#define SHARED_TAPS 9
#ifdef SHARED_BY_QUADS
#define SHARED_REACH 2.5
#else
#define SHARED_REACH 3.0
#endif

ivec2 asked_at(ivec2 texel)
{
#ifdef SHARED_BY_QUADS
  return min(2 * texel + lane, textureSize(SHARED_POSITION, 0) - 1);
#else
  return texel;
#endif
}

bool shares_rays(ivec2 other, vec4 place, vec3 normal)
{
  vec4 there = texelFetch(SHARED_POSITION, other, 0);
  vec3 off = there.xyz - place.xyz;
  vec3 turned = texelFetch(SHARED_NORMAL, other, 0).xyz;
  return there.w == place.w && dot(turned, normal) > 0.9 && abs(dot(off, normal)) <= 0.2 * length(off);
}

vec3 shared_rays(ivec2 pixel, vec4 place, vec3 normal, Surface s, vec3 to_viewer)
{
#ifdef SHARED_BY_QUADS
  ivec2 own = pixel >> 1;
#else
  ivec2 own = pixel;
#endif
  ivec2 most = textureSize(gather_light, 0) - 1;
  vec3 off_base = vec3(0.0), shining = vec3(0.0), own_shining = vec3(0.0);
  bool is_shadowed = false;  // some of those that went to where light comes from
  float count = 0.0;
  // The first that is shared stands for the pixel's own where only one ray will do: that of its quad, mostly.
  vec4 own_light = vec4(0.0);
  ivec2 own_texel = own;
  // (Others about it by chance: a fixed pattern would be seen.)
  uint seed = hashed(uint(pixel.x) | (uint(pixel.y) << 16u)) + uint(share_turn);
  ivec2 texels[SHARED_TAPS];
  float away[SHARED_TAPS];  // from the pixel's own place; -1: of another surface
  float nearness = 0.0, rays = 0.0;
  for (int k = 0; k < SHARED_TAPS; k++) {
    ivec2 texel = own;
    if (k > 0) {
      seed = hashed(seed + uint(k));
      vec2 random = vec2(float(seed & 65535u), float(seed >> 16u)) / 65536.0;
      float angle = 2.0 * LIGHTING_PI * (random.x + float(k)) / float(SHARED_TAPS - 1);
      vec2 off = SHARED_REACH * sqrt((float(k) - random.y) / float(SHARED_TAPS - 1)) * vec2(cos(angle), sin(angle));
      texel = clamp(own + ivec2(round(off)), ivec2(0), most);
    }
    texels[k] = texel;
    away[k] = -1.0;
    if (texelFetch(gather_light, texel, 0).w != RAY_NONE && shares_rays(asked_at(texel), place, normal)) {
      away[k] = distance(texelFetch(SHARED_POSITION, asked_at(texel), 0).xyz, place.xyz);
      nearness += 1.0 / max(texelFetch(gather_way, texel, 0).w, 1e-20);
      rays += 1.0;
    }
  }
  // Light changes over a share of the harmonic mean of the distances that it comes from (Ward et al., "A ray tracing
  // solution for diffuse interreflection", 1988).
  float reach = SHARED_WAY * rays / max(nearness, 1e-30);
  for (int k = 0; k < SHARED_TAPS; k++) {
    if (away[k] >= 0.0 && (away[k] <= reach || count == 0.0)) {
      vec4 light = texelFetch(gather_light, texels[k], 0);
      bool is_own = count == 0.0;
      count += 1.0;
      own_light = is_own ? light : own_light;
      own_texel = is_own ? texels[k] : own_texel;
      off_base += light.w == RAY_OFF_BASE ? light.rgb : vec3(0.0);
#ifdef EMITTERS
      if (light.w == RAY_TO_EMITTER) {
        vec3 direction = way_direction(texelFetch(gather_way, texels[k], 0));
        // (By the normal there, which its chance was found with: by another the ray might count far too much.)
        vec3 there = texelFetch(SHARED_NORMAL, asked_at(texels[k]), 0).xyz;
        vec3 found = light.rgb * (max(dot(there, direction), 0.0) / LIGHTING_PI);
        shining += found;
        own_shining = is_own ? found : own_shining;
      }
      is_shadowed = is_shadowed || light.w == RAY_SHADOWED;
#endif
    }
  }
  Lobes lobes = lobes_of(s, dot(s.normal, to_viewer));
#ifdef LIGHTING_INDIRECT
  if (count == 0.0) {
    // What its patch knows stands in.
    return surfaces_on(s, lobes);
  }
#endif
  // (At the edge of a shadow each has its own alone: rays that agree are as good as one another's, so the mean is
  // right.)
  vec3 sum = off_base / max(count, 1.0);
  sum += is_shadowed ? own_shining : shining / max(count, 1.0);
  sum *= lobes.diffuse;
  if (own_light.w == RAY_OFF_LOBE || own_light.w == RAY_TO_EMITTER) {
    vec3 direction = way_direction(texelFetch(gather_way, own_texel, 0));
    vec3 there = texelFetch(SHARED_NORMAL, asked_at(own_texel), 0).xyz;
    bool is_lobe = own_light.w == RAY_OFF_LOBE;
    vec3 value = is_lobe ? lobes.specular_albedo : lobe_value(lobes, there, to_viewer, direction);
#ifdef SURFACE_TRANSLUCENT
    value += is_lobe ? vec3(0.0) : lobes.translucent * (max(-dot(there, direction), 0.0) / LIGHTING_PI);
#endif
    sum += own_light.rgb * value;
  }
#ifdef SURFACE_TRANSLUCENT
  sum += own_light.w == RAY_THROUGH ? own_light.rgb * lobes.translucent : vec3(0.0);
#endif
  return sum;
}
