// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// How much of a caster is there. Needs the sampler (FLOAT_2D) `caster_alphas` of renderer/lighting/shadow_alpha.py:
// records of each material (alpha or -1 for an image, threshold, inverted, row where the image begins); (scale, offset
// of uv); (turn of uv, width, height); (tint, extension, plus 4 for the nearest texel); then the images' alphas.
#include "common/records.glsl"

// A texel of an image that begins at a row; beyond its border as the extension says.
float caster_texel(int row, ivec2 size, ivec2 place, int extension)
{
  if (extension == 3 && (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size)))) {
    return 0.0;
  }
  if (extension == 0 || extension == 2) {
    ivec2 tile = ivec2(floor(vec2(place) / vec2(size)));
    place -= tile * size;
    if (extension == 2) {
      place = ivec2((tile.x & 1) != 0 ? size.x - 1 - place.x : place.x,
                    (tile.y & 1) != 0 ? size.y - 1 - place.y : place.y);
    }
  }
  place = clamp(place, ivec2(0), size - 1);
  int texel = place.y * size.x + place.x;
  return texelFetch(caster_alphas, texel_of_record(texel >> 2) + ivec2(0, row), 0)[texel & 3];
}

float caster_image(int row, ivec2 size, vec2 uv, int way)
{
  int extension = way & 3;
  vec2 place = uv * vec2(size);
  // (Casts of endless numbers are not defined.)
  place = clamp(place, vec2(-1e6), vec2(1e6));
  if ((way & 4) != 0) {
    return caster_texel(row, size, ivec2(floor(place)), extension);
  }
  place -= 0.5;
  ivec2 corner = ivec2(floor(place));
  vec2 part = place - vec2(corner);
  float low = mix(caster_texel(row, size, corner, extension),
                  caster_texel(row, size, corner + ivec2(1, 0), extension), part.x);
  float high = mix(caster_texel(row, size, corner + ivec2(0, 1), extension),
                   caster_texel(row, size, corner + ivec2(1, 1), extension), part.x);
  return mix(low, high, part.y);
}

// Share of light that gets straight through a material at this place.
vec3 light_through(int material, vec2 uv)
{
  int record = ALPHA_RECORDS * material;
  vec4 about = fetch_record(caster_alphas, record);
  vec4 tint = fetch_record(caster_alphas, record + 3);
  float alpha = about.x;
  if (alpha < 0.0) {
    vec4 transform = fetch_record(caster_alphas, record + 1);
    vec4 turn = fetch_record(caster_alphas, record + 2);
    vec2 place = uv * transform.xy + transform.zw + turn.xy * uv.yx;
    alpha = caster_image(int(about.w + 0.5), ivec2(turn.zw + 0.5), place, int(tint.w + 0.5));
  }
  if (about.y >= 0.0) {
    alpha = (alpha > about.y) != (about.z > 0.5) ? 1.0 : 0.0;
  }
  return (1.0 - clamp(alpha, 0.0, 1.0)) * tint.rgb;
}
