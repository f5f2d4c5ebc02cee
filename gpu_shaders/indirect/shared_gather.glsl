// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light of rays between surfaces, of which one pixel of each quad (`lane`, another one in each sub-frame) has followed
// one for all four. A pixel of another surface than that one's has its own rays alone, when its turn comes: they count
// for those that it does not share. Needs the samplers `gather_light` (radiance over the chance of the ray; w: what
// it was) and `gather_way`, and the push constant `lane` (IVEC2).
#include "indirect/followed_value.glsl"
#include "paths/path_state.glsl"

bool shares_rays(ivec2 other, vec4 place, vec4 facing)
{
  vec4 there = texelFetch(seen_position, other, 0);
  vec4 turned = texelFetch(seen_normal, other, 0);
  float away = length(there.xyz - place.xyz);
  return there.w == place.w && turned.w == facing.w && dot(turned.xyz, facing.xyz) > 0.9 &&
         abs(dot(there.xyz - place.xyz, facing.xyz)) <= 0.25 * away;
}

vec3 shared_rays(ivec2 pixel, vec4 place, vec4 facing, Surface s, vec3 to_viewer)
{
  ivec2 most = textureSize(seen_position, 0) - 1;
  ivec2 first = pixel & ivec2(-2);
  ivec2 asked = min(first + lane, most);
  float counts = 1.0;
  if (asked == pixel) {
    for (int k = 0; k < 4; k++) {
      ivec2 other = first + ivec2(k & 1, k >> 1);
      bool is_own = other == pixel;
      bool is_there = all(lessThanEqual(other, most));
      counts += is_own || (is_there && shares_rays(other, place, facing)) ? 0.0 : 1.0;
    }
  }
  else {
    counts = shares_rays(asked, place, facing) ? 1.0 : 0.0;
  }
  vec4 light = texelFetch(gather_light, pixel >> 1, 0);
  vec3 sum = vec3(0.0);
  if (light.w > 0.5 && counts > 0.0) {
    float cos_viewer = dot(s.normal, to_viewer);
    s.normal *= cos_viewer < 0.0 ? -1.0 : 1.0;
    Lobes lobes = lobes_of(s, abs(cos_viewer));
    vec3 direction = way_direction(texelFetch(gather_way, pixel >> 1, 0));
    vec3 value = light.w > 2.5 ? followed_value(lobes, s.normal, to_viewer, direction) :
                 (light.w > 1.5 ? lobes.specular_albedo : lobes.diffuse);
    sum = counts * value * light.rgb;
  }
  return sum;
}
