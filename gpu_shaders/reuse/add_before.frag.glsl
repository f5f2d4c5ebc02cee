// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// An earlier frame's picture where it has shown the same (`found_before`), with what the mirror takes of it now. Where
// something `has_moved`, another's light may have changed, and what shows several things at once moves in several
// ways: then it is no farther than CLAMP standard deviations from the mean of what the same thing shows around the
// pixel now. With `mirrors_only` above 0 of mirrors alone.
#include "reuse/earlier_frame.glsl"

vec4 untinted(ivec2 place)
{
  vec4 texel = texelFetch(then_picture, place, 0);
  return vec4(texel.rgb / max(texelFetch(then_tint, place, 0).rgb, vec3(DARKEST_TINT)), texel.a);
}

// Catmull and Rom's weights of four texels.
vec4 sharp_weights(float part)
{
  float part2 = part * part, part3 = part2 * part;
  return 0.5 * vec4(-part3 + 2.0 * part2 - part, 3.0 * part3 - 5.0 * part2 + 2.0, -3.0 * part3 + 4.0 * part2 + part,
                    part3 - part2);
}

// The picture between pixels that show the same thing; alpha of `whole` is how much of it there is.
vec4 picture_at(vec2 at, out float whole)
{
  vec2 corner = floor(at - 0.5), part = at - 0.5 - corner;
  ivec2 base = ivec2(corner);
  vec4 low = vec4(1e30), high = vec4(-1e30), sum = vec4(0.0), sharp = vec4(0.0);
  whole = 0.0;
  bool all_fit = true;
  vec4 across = sharp_weights(part.x), up = sharp_weights(part.y);
  for (int y = 0; y < 4; y++) {
    for (int x = 0; x < 4; x++) {
      ivec2 place = base + ivec2(x - 1, y - 1);
      bool is_there = fits(place);
      all_fit = all_fit && is_there;
      if (is_there) {
        vec4 texel = untinted(place);
        sharp += across[x] * up[y] * texel;
        if (x > 0 && x < 3 && y > 0 && y < 3) {
          float weight = (x == 1 ? 1.0 - part.x : part.x) * (y == 1 ? 1.0 - part.y : part.y);
          sum += weight * texel;
          whole += weight;
          low = min(low, texel);
          high = max(high, texel);
        }
      }
    }
  }
  return all_fit ? clamp(sharp, low, high) : sum / max(whole, 1e-6);
}

// Mean and standard deviation of how the same thing looks around a pixel now.
void around(ivec2 pixel, float mirror, out vec3 mean, out vec3 deviation)
{
  ivec2 last = textureSize(now_picture, 0) - 1;
  float thing = texelFetch(now_shown, pixel, 0).w;
  vec3 sum = vec3(0.0), squares = vec3(0.0);
  float count = 0.0;
  for (int y = -1; y <= 1; y++) {
    for (int x = -1; x <= 1; x++) {
      ivec2 other = clamp(pixel + ivec2(x, y), ivec2(0), last);
      vec4 tint = texelFetch(now_tint, other, 0);
      if (tint.w == mirror && texelFetch(now_shown, other, 0).w == thing) {
        vec3 there = texelFetch(now_picture, other, 0).rgb / max(tint.rgb, vec3(DARKEST_TINT));
        sum += there;
        squares += there * there;
        count += 1.0;
      }
    }
  }
  mean = sum / count;
  deviation = sqrt(max(squares / count - mean * mean, vec3(0.0)));
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 found = texelFetch(found_before, pixel, 0);
  vec4 tint = texelFetch(now_tint, pixel, 0);
  added = count = vec4(0.0);
  bool shows_several = tint.w <= SHOWS_SEVERAL;
  bool is_mirror = shows_several ? tint.w < SHOWS_SEVERAL - 0.5 : tint.w > 0.5;
  if (found.z < 0.5 || (mirrors_only > 0.5 && !is_mirror)) {
    return;
  }
  ivec2 place = ivec2(floor(found.xy));
  wanted_code = texelFetch(then_shown, place, 0).w;
  wanted_mirror = texelFetch(then_tint, place, 0).w;
  float whole;
  vec4 texel = picture_at(found.xy, whole);
  if (whole < LEAST_WHOLE) {
    return;
  }
  if (has_moved > 0.5 || shows_several) {
    vec3 mean, deviation;
    around(pixel, tint.w, mean, deviation);
    texel.rgb = clamp(texel.rgb, mean - CLAMP * deviation, mean + CLAMP * deviation);
  }
  added = vec4(tint.rgb * texel.rgb, texel.a);
  count = vec4(1.0);
}
