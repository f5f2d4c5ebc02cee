// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What mirrors show while the view moves: sharp ones what they do, rough ones the mean of TAPS places of their
// ellipse, spread as the slopes of GGX (of which u have a square below alpha^2 u / (1 - u)) on a spiral of golden
// angles that is the same at every pixel and in every frame. A place has the level whose texels are as wide as
// places lie apart. Places of other mirrors, and those whose normal has turned farther than a lobe is wide, count
// for nothing, the rest for more. LEVEL_CASES is a CASE of each of the LEVELS textures (renderer/shading/calm.py).
#include "calm/calm_level.glsl"
#include "calm/calm_tint.glsl"
#include "surfaces/material_at.glsl"
#include "surfaces/material_number.glsl"
#define CASE(index, texels) if (level == index) { found = bilinear(texels, level, place, number); }

vec4 one_mirror(vec4 texel, float number)
{
  return number_of(texel) == number ? vec4(texel.rgb, share_of(texel)) : vec4(0.0);
}

// Light times share, and share; `place` in pixels of the picture.
vec4 bilinear(sampler2D texels, int level, vec2 place, float number)
{
  ivec2 last = textureSize(texels, 0) - 1;
  vec2 at = place * exp2(-float(level)) - 0.5;
  ivec2 corner = ivec2(floor(at));
  vec2 part = at - floor(at);
  ivec2 low = clamp(corner, ivec2(0), last), high = clamp(corner + 1, ivec2(0), last);
  vec4 below = mix(one_mirror(texelFetch(texels, low, 0), number),
                   one_mirror(texelFetch(texels, ivec2(high.x, low.y), 0), number), part.x);
  vec4 above = mix(one_mirror(texelFetch(texels, ivec2(low.x, high.y), 0), number),
                   one_mirror(texelFetch(texels, high, 0), number), part.x);
  return mix(below, above, part.y);
}

vec4 at_level(int level, vec2 place, float number)
{
  vec4 found = vec4(0.0);
  LEVEL_CASES
  return found;
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 sharp = texelFetch(sharp_picture, pixel, 0);
  vec4 ellipse = texelFetch(calm_reach, pixel, 0);
  if (ellipse.x == 0.0) {
    color = sharp;
    return;
  }
  float number = texelFetch(seen_color, pixel, 0).w;
  vec4 facing = texelFetch(seen_normal, pixel, 0);
  float roughness = material_at(pixel, material_number(facing.w), vec3(0.0)).roughness;
  mat2 root = mat2(ellipse.x, ellipse.y, ellipse.y, ellipse.z);
  float extent = sqrt(max(determinant(root), 0.0));
  vec2 size = vec2(textureSize(seen_color, 0));
  vec4 sum = vec4(0.0);
  for (int k = 0; k < TAPS; k++) {
    float u = (float(k) + 0.5) / float(TAPS);
    float slope2 = u / (1.0 - u);
    float turn = GOLDEN_ANGLE * float(k);
    vec2 toward = vec2(cos(turn), sin(turn));
    // (And those of a pixel's filter, a Gaussian.)
    vec2 place = gl_FragCoord.xy + root * (sqrt(slope2) * toward) + PIXEL * sqrt(-2.0 * log(1.0 - u)) * toward;
    if (all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, size))) {
      ivec2 other = ivec2(place);
      float alike = 1.0;
      if (texelFetch(seen_color, other, 0).w == number) {
        float turned = length(texelFetch(seen_normal, other, 0).xyz - facing.xyz);
        float wide = CREASE + 2.0 * roughness * roughness * sqrt(slope2);
        alike = clamp(2.0 - turned / wide, 0.0, 1.0);
      }
      // (The density of places is that of the slopes.)
      float spacing = (extent * (1.0 + slope2) + PIXEL) * SPACING;
      float level = clamp(log2(max(spacing, 1e-6)), 0.0, float(LEVELS - 1));
      float finer = min(floor(level), float(LEVELS - 2));
      sum += alike * mix(at_level(int(finer), place, number), at_level(int(finer) + 1, place, number), level - finer);
    }
  }
  color = sharp;
  if (sum.a > 1e-3) {
    color.rgb = tint_at(pixel) * sum.rgb / sum.a;
  }
}
