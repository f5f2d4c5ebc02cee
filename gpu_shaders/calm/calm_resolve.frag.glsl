// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A moving picture's mirrors: a part of what they show now, the rest of what they have shown one frame before, where
// the image behind the mirror was then, as far as that lies among what the pixels around show now (Karis, "High-
// Quality Temporal Supersampling", 2014). So that an edge that jumps by a pixel does so over a few frames. Alpha is
// the mirror's number.
vec4 before_at(vec2 place, float number)
{
  ivec2 last = textureSize(last_picture, 0) - 1;
  vec2 at = place - 0.5;
  vec4 sum = vec4(0.0);
  for (int k = 0; k < 4; k++) {
    ivec2 corner = ivec2(floor(at)) + ivec2(k & 1, k >> 1);
    vec2 part = 1.0 - abs(at - vec2(corner));
    vec4 texel = texelFetch(last_picture, clamp(corner, ivec2(0), last), 0);
    sum += texel.a == number ? part.x * part.y * vec4(texel.rgb, 1.0) : vec4(0.0);
  }
  return sum;
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(seen_color, 0) - 1;
  float number = texelFetch(seen_color, pixel, 0).w;
  vec4 now = texelFetch(blurred_picture, pixel, 0);
  vec3 light = now.rgb;
  color = now.a > 0.5 ? vec4(light, number) : vec4(0.0);
  if (now.a < 0.5 || texelFetch(calm_reach, pixel, 0).x == 0.0) {
    return;
  }
  vec3 place_here = texelFetch(seen_position, pixel, 0).xyz;
  vec3 onward = normalize(place_here * view.eye.w - view.eye.xyz);
  float nearness = texelFetch(calm_reach, pixel, 0).w;
  vec4 clip = last_to_clip * vec4(place_here * nearness + onward, nearness);
  vec2 place = (0.5 * clip.xy / clip.w + 0.5) * vec2(last + 1);
  vec4 before = before_at(place, number);
  if (before.a < 0.5) {
    return;
  }
  vec3 least = light, most = light;
  for (int y = -1; y <= 1; y++) {
    for (int x = -1; x <= 1; x++) {
      ivec2 other = clamp(pixel + ivec2(x, y), ivec2(0), last);
      if (texelFetch(seen_color, other, 0).w == number) {
        vec3 there = texelFetch(blurred_picture, other, 0).rgb;
        least = min(least, there);
        most = max(most, there);
      }
    }
  }
  vec3 margin = MARGIN * (most - least) + 0.02 * light;
  least -= margin;
  most += margin;
  color.rgb = mix(clamp(before.rgb / before.a, least, most), light, PART_OF_NOW);
}
