// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Cycles, Apache-2.0 and BSD-3-Clause)
// SPDX-License-Identifier: GPL-3.0-or-later
// Where image nodes look up their images. Ported from Cycles' kernel/svm/image.h, kernel/camera/projection.h and
// util/math_dual.h.
#include "programs/images.glsl"

#define IMAGE_PI 3.14159265358979

vec2 image_flat(vec3 place)
{
  return place.xy;
}

vec2 image_tube(vec3 place)
{
  vec3 d = place * 2.0 - 1.0;
  return length(d.xy) > 0.0 ? vec2(0.5 - 0.5 * atan(d.x, d.y) / IMAGE_PI, 0.5 * (d.z + 1.0)) : vec2(0.0);
}

vec2 image_sphere(vec3 place)
{
  vec3 d = place * 2.0 - 1.0;
  float square = dot(d, d);
  if (square <= 0.0) {
    return vec2(0.0);
  }
  float u = d.x == 0.0 && d.y == 0.0 ? 0.0 : 0.5 - 0.5 * atan(d.x, d.y) / IMAGE_PI;
  return vec2(u, 1.0 - acos(clamp(d.z * inversesqrt(square), -1.0, 1.0)) / IMAGE_PI);
}

vec2 image_equirectangular(vec3 place)
{
  float size = length(place);
  if (size == 0.0) {
    return vec2(0.0);
  }
  vec3 d = place / size;
  float u = d.x == 0.0 && d.y == 0.0 ? 0.0 : atan(d.y, d.x);
  return vec2(0.5 - 0.5 * u / IMAGE_PI, 1.0 - acos(clamp(d.z, -1.0, 1.0)) / IMAGE_PI);
}

vec2 image_mirror_ball(vec3 place)
{
  float size = length(place);
  vec3 d = size == 0.0 ? place : place / size;
  d.y -= 1.0;
  float divisor = 2.0 * sqrt(max(-0.5 * d.y, 0.0));
  return 0.5 * (divisor > 0.0 ? d.xz / divisor : d.xz) + 0.5;
}

// Number of the tile that coordinates are on, 0 where there can be none; and where it begins.
int image_tile(vec2 uv)
{
  ivec2 place = ivec2(uv);
  return place.x < 0 || place.y < 0 || place.x >= 10 ? 0 : 1001 + 10 * place.y + place.x;
}

vec2 image_tile_corner(vec2 uv)
{
  return trunc(uv);
}

// Shares of the projections along X, Y and Z, for a normal in object space.
vec3 image_box_weights(vec3 normal, float blend)
{
  vec3 n = abs(normal);
  n /= n.x + n.y + n.z;
  float limit = 0.5 * (1.0 + blend);
  if (n.x > limit * (n.x + n.y) && n.x > limit * (n.x + n.z)) {
    return vec3(1.0, 0.0, 0.0);
  }
  if (n.y > limit * (n.x + n.y) && n.y > limit * (n.y + n.z)) {
    return vec3(0.0, 1.0, 0.0);
  }
  if (n.z > limit * (n.x + n.z) && n.z > limit * (n.y + n.z)) {
    return vec3(0.0, 0.0, 1.0);
  }
  if (blend <= 0.0) {
    return vec3(1.0, 0.0, 0.0);
  }
  // Two sides, each with its share between the two limits; or three.
  float start = 0.5 * (1.0 - blend);
  if (n.z < (1.0 - limit) * (n.y + n.x)) {
    float x = clamp((n.x / (n.x + n.y) - start) / blend, 0.0, 1.0);
    return vec3(x, 1.0 - x, 0.0);
  }
  if (n.x < (1.0 - limit) * (n.y + n.z)) {
    float y = clamp((n.y / (n.y + n.z) - start) / blend, 0.0, 1.0);
    return vec3(0.0, y, 1.0 - y);
  }
  if (n.y < (1.0 - limit) * (n.x + n.z)) {
    float x = clamp((n.x / (n.x + n.z) - start) / blend, 0.0, 1.0);
    return vec3(x, 0.0, 1.0 - x);
  }
  return ((2.0 - limit) * n + (limit - 1.0)) / (2.0 * limit - 1.0);
}

#define IMAGE_BOX(lookup) \
  vec3 p = place; \
  vec3 weights = image_box_weights(normal, blend); \
  vec4 sum = vec4(0.0); \
  if (weights.x > 0.0) { \
    sum += weights.x * lookup(s, record, vec2(normal.x < 0.0 ? 1.0 - p.y : p.y, p.z), extension, divides); \
  } \
  if (weights.y > 0.0) { \
    sum += weights.y * lookup(s, record, vec2(normal.y > 0.0 ? 1.0 - p.x : p.x, p.z), extension, divides); \
  } \
  if (weights.z > 0.0) { \
    sum += weights.z * lookup(s, record, vec2(normal.z > 0.0 ? 1.0 - p.y : p.y, p.x), extension, divides); \
  } \
  return sum;

vec4 image_box_closest(ShadingPoint s, int record, vec3 place, vec3 normal, float blend, int extension, bool divides)
{
  IMAGE_BOX(image_lookup_closest)
}

vec4 image_box_linear(ShadingPoint s, int record, vec3 place, vec3 normal, float blend, int extension, bool divides)
{
  IMAGE_BOX(image_lookup_linear)
}

vec4 image_box_cubic(ShadingPoint s, int record, vec3 place, vec3 normal, float blend, int extension, bool divides)
{
  IMAGE_BOX(image_lookup_cubic)
}
