// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// How much of a caster is there. Needs the sampler (FLOAT_2D) `caster_alphas` of renderer/lighting/shadow_alpha.py:
// records of each material (alpha or -1 for an image, row where the image begins, number of the attribute it is on, 1
// where all is there or not); (lowest texture coordinates in the image, and how far it reaches); (tint, width + SIDE
// height); then the images' alphas.
#include "common/records.glsl"

float caster_texel(int row, ivec2 size, ivec2 place)
{
  place = clamp(place, ivec2(0), size - 1);
  int texel = place.y * size.x + place.x;
  return texelFetch(caster_alphas, texel_of_record(texel >> 2) + ivec2(0, row), 0)[texel & 3];
}

float caster_image(int row, ivec2 size, vec2 place)
{
  // (Casts of endless numbers are not defined.)
  place = clamp(place * vec2(size), vec2(-1e6), vec2(1e6)) - 0.5;
  ivec2 corner = ivec2(floor(place));
  vec2 part = place - vec2(corner);
  float low = mix(caster_texel(row, size, corner), caster_texel(row, size, corner + ivec2(1, 0)), part.x);
  corner.y++;
  float high = mix(caster_texel(row, size, corner), caster_texel(row, size, corner + ivec2(1, 0)), part.x);
  return mix(low, high, part.y);
}

// Number of the attribute whose texture coordinates `light_through` asks for; below 0: none.
int light_through_attribute(int material)
{
  return int(round(fetch_record(caster_alphas, ALPHA_RECORDS * material).z));
}

// Share of light that gets straight through a material at this place.
vec3 light_through(int material, vec2 uv)
{
  int record = ALPHA_RECORDS * material;
  vec4 about = fetch_record(caster_alphas, record);
  vec4 tint = fetch_record(caster_alphas, record + 2);
  float alpha = about.x;
  if (alpha < 0.0) {
    vec4 part = fetch_record(caster_alphas, record + 1);
    int sides = int(tint.w + 0.5);
    alpha = caster_image(int(about.y + 0.5), ivec2(sides % SIDE, sides / SIDE), (uv - part.xy) / part.zw);
    alpha = about.w > 0.5 ? step(0.5, alpha) : alpha;
  }
  return (1.0 - clamp(alpha, 0.0, 1.0)) * tint.rgb;
}
