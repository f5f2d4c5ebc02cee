// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light of rays between surfaces that pixels share: those off the base with the texels of `gather_light` about the
// pixel's own whose rays began on the same surface nearby. With SHARED_BY_QUADS a quad of pixels has one texel, whose
// ray began at one of them (`lane`), another one in each sub-frame. `gather_light`: radiance over the chance of the ray;
// w: what it was. Needs `gather_way`, the push constant `share_turn` (INT: of the sub-frame) and the samplers SHARED_POSITION and SHARED_NORMAL of where rays began.
#include "indirect/followed_value.glsl"
#include "paths/path_state.glsl"
#include "common/hash.glsl"

// How many texels are asked, and how far off.
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
  vec3 off_base = vec3(0.0);
  float count = 0.0;
  bool has_own = false;
  // (Others about it by chance: a fixed pattern would be seen.)
  uint seed = hashed(uint(pixel.x) | (uint(pixel.y) << 16u)) + uint(share_turn);
  for (int k = 0; k < SHARED_TAPS; k++) {
    ivec2 texel = own;
    if (k > 0) {
      seed = hashed(seed + uint(k));
      vec2 random = vec2(float(seed & 65535u), float(seed >> 16u)) / 65536.0;
      float angle = 2.0 * LIGHTING_PI * (random.x + float(k)) / float(SHARED_TAPS - 1);
      vec2 off = SHARED_REACH * sqrt((float(k) - random.y) / float(SHARED_TAPS - 1)) * vec2(cos(angle), sin(angle));
      texel = clamp(own + ivec2(round(off)), ivec2(0), most);
    }
    vec4 light = texelFetch(gather_light, texel, 0);
    if (light.w > 0.5 && shares_rays(asked_at(texel), place, normal)) {
      count += 1.0;
      off_base += light.w < 1.5 ? light.rgb : vec3(0.0);
      has_own = has_own || k == 0;
    }
  }
  float cos_viewer = dot(s.normal, to_viewer);
  s.normal *= cos_viewer < 0.0 ? -1.0 : 1.0;
  Lobes lobes = lobes_of(s, abs(cos_viewer));
#ifdef LIGHTING_INDIRECT
  if (count == 0.0) {
    // What its patch knows stands in.
    return surfaces_on(s, lobes);
  }
#endif
  vec3 sum = lobes.diffuse * off_base / max(count, 1.0);
  vec4 light = texelFetch(gather_light, own, 0);
  // (Where the quad's ray is another surface's, none of the pixel's own stands for it: three rays in four.)
  if (has_own && light.w > 1.5) {
    vec3 direction = way_direction(texelFetch(gather_way, own, 0));
    sum += light.rgb * (light.w < 2.5 ? lobes.specular_albedo : followed_value(lobes, s.normal, to_viewer, direction));
  }
  return sum;
}
