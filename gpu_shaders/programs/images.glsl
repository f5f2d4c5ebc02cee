// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Cycles, Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Looks up the images of programs. Ported from Cycles' kernel/device/cpu/image.h and svm/image.h.
//
// Needs the samplers image_bytes_0.. (IMAGE_BYTES of them), image_halves_0.. (IMAGE_HALVES), and PAGE_BITS: see
// renderer/programs/image_pages.py. Extensions and flags are constants wherever these functions are called.
#include "programs/shading_point.glsl"

#define IMAGE_REPEAT 0
#define IMAGE_EXTEND 1
#define IMAGE_CLIP 2
#define IMAGE_MIRROR 3

#define IMAGE_MISSING vec4(1.0, 0.0, 1.0, 1.0)
#define IMAGE_PENDING vec4(0.5, 0.5, 0.5, 1.0)

struct ImagePlace {
  int first_row;
  ivec2 size;       // 0: missing; -1: not there yet
  int array;
  int bits;         // of the rows in a layer
  float factor;
  bool is_encoded;
};

ImagePlace image_place(ShadingPoint s, int record)
{
  vec4 first = P(record);
  vec4 second = P(record + 1);
  return ImagePlace(int(first.x), ivec2(first.yz), int(first.w), int(second.x), second.y, second.z > 0.5);
}

vec4 image_fetch(ImagePlace image, ivec2 pixel)
{
  int index = pixel.y * image.size.x + pixel.x;
  int row = image.first_row + (index >> PAGE_BITS);
  ivec3 place = ivec3(index & ((1 << PAGE_BITS) - 1), row & ((1 << image.bits) - 1), row >> image.bits);
#if IMAGE_BYTES > 0
  if (image.array == 0) {
    return texelFetch(image_bytes_0, place, 0);
  }
#endif
#if IMAGE_BYTES > 1
  if (image.array == 1) {
    return texelFetch(image_bytes_1, place, 0);
  }
#endif
#if IMAGE_BYTES > 2
  if (image.array == 2) {
    return texelFetch(image_bytes_2, place, 0);
  }
#endif
#if IMAGE_HALVES > 0
  if (image.array == IMAGE_BYTES) {
    return image.factor * texelFetch(image_halves_0, place, 0);
  }
#endif
#if IMAGE_HALVES > 1
  if (image.array == IMAGE_BYTES + 1) {
    return image.factor * texelFetch(image_halves_1, place, 0);
  }
#endif
#if IMAGE_HALVES > 2
  if (image.array == IMAGE_BYTES + 2) {
    return image.factor * texelFetch(image_halves_2, place, 0);
  }
#endif
  return vec4(0.0);
}

int image_wrapped(int x, int size, int extension)
{
  if (extension == IMAGE_REPEAT) {
    return x < 0 ? size - 1 - (-1 - x) % size : x % size;
  }
  if (extension == IMAGE_MIRROR) {
    int m = abs(x + (x < 0 ? 1 : 0)) % (2 * size);
    return m >= size ? 2 * size - m - 1 : m;
  }
  return clamp(x, 0, size - 1);
}

vec4 image_texel(ImagePlace image, ivec2 pixel, int extension)
{
  if (extension == IMAGE_CLIP && (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, image.size)))) {
    return vec4(0.0);
  }
  return image_fetch(image, ivec2(image_wrapped(pixel.x, image.size.x, extension),
                                  image_wrapped(pixel.y, image.size.y, extension)));
}

vec4 image_closest(ImagePlace image, vec2 uv, int extension)
{
  return image_texel(image, ivec2(floor(uv * vec2(image.size))), extension);
}

vec4 image_linear(ImagePlace image, vec2 uv, int extension)
{
  vec2 place = uv * vec2(image.size) - 0.5;
  vec2 corner = floor(place);
  vec2 t = place - corner;
  ivec2 pixel = ivec2(corner);
  return mix(mix(image_texel(image, pixel, extension), image_texel(image, pixel + ivec2(1, 0), extension), t.x),
             mix(image_texel(image, pixel + ivec2(0, 1), extension),
                 image_texel(image, pixel + ivec2(1, 1), extension), t.x), t.y);
}

vec4 image_spline(float t)
{
  return vec4(((-t / 6.0 + 0.5) * t - 0.5) * t + 1.0 / 6.0, ((0.5 * t - 1.0) * t) * t + 2.0 / 3.0,
              ((-0.5 * t + 0.5) * t + 0.5) * t + 1.0 / 6.0, t * t * t / 6.0);
}

vec4 image_cubic(ImagePlace image, vec2 uv, int extension)
{
  vec2 place = uv * vec2(image.size) - 0.5;
  vec2 corner = floor(place);
  vec4 u = image_spline(place.x - corner.x);
  vec4 v = image_spline(place.y - corner.y);
  ivec2 pixel = ivec2(corner) - 1;
  vec4 sum = vec4(0.0);
  for (int y = 0; y < 4; y++) {
    for (int x = 0; x < 4; x++) {
      sum += u[x] * v[y] * image_texel(image, pixel + ivec2(x, y), extension);
    }
  }
  return sum;
}

// `divides`: colors, which are kept multiplied with alpha, are divided by it, as the node's alpha is looked at too.
vec4 image_decoded(ImagePlace image, vec4 value, bool divides)
{
  if (divides && value.a != 1.0 && value.a != 0.0) {
    value.rgb /= value.a;
  }
  if (image.is_encoded) {
    vec3 curve = pow((max(value.rgb, 0.0) + 0.055) / 1.055, vec3(2.4));
    value.rgb = mix(curve, max(value.rgb, 0.0) / 12.92, vec3(lessThan(value.rgb, vec3(0.04045))));
  }
  return value;
}

#define IMAGE_LOOKUP(interpolated) \
  if (record < 0) { \
    return IMAGE_MISSING; \
  } \
  ImagePlace image = image_place(s, record); \
  if (image.size.x <= 0) { \
    return image.size.x < 0 ? IMAGE_PENDING : IMAGE_MISSING; \
  } \
  return image_decoded(image, interpolated(image, uv, extension), divides);

// `record`: the first of the program's two records of an image, or -1 for none.
vec4 image_lookup_closest(ShadingPoint s, int record, vec2 uv, int extension, bool divides)
{
  IMAGE_LOOKUP(image_closest)
}

vec4 image_lookup_linear(ShadingPoint s, int record, vec2 uv, int extension, bool divides)
{
  IMAGE_LOOKUP(image_linear)
}

vec4 image_lookup_cubic(ShadingPoint s, int record, vec2 uv, int extension, bool divides)
{
  IMAGE_LOOKUP(image_cubic)
}
