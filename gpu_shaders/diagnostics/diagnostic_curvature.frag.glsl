// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Curvature as colors of a ramp, from the tensors that `curvature.frag.glsl` has drawn. The define of its name says
// which one; with DIRECTIONS strokes along the principal directions lie over it, one pair in each cell of pixels.
#include "diagnostics/diagnostic_mirror.glsl"

#define CELL 20
#define STROKE vec2(7.5, 0.8)

struct Bent {
  bool is_known;
  mat3 tensor;
  float mean;
  float spread;  // half the difference of the principal curvatures
};

Bent bent_at(ivec2 pixel, float number)
{
  vec4 diagonal = texelFetch(curved_diagonal, pixel, 0);
  vec3 across = texelFetch(curved_across, pixel, 0).xyz;
  Bent bent;
  bent.is_known = abs(diagonal.w - number) < 0.5;
  bent.tensor = mat3(diagonal.x, across.x, across.y, across.x, diagonal.y, across.z, across.y, across.z, diagonal.z);
  bent.mean = 0.5 * (diagonal.x + diagonal.y + diagonal.z);
  // The mean of the squares of a tensor's entries is that of its eigenvalues, of which one is 0.
  float squares = dot(diagonal.xyz, diagonal.xyz) + 2.0 * dot(across, across);
  bent.spread = sqrt(max(0.5 * squares - bent.mean * bent.mean, 0.0));
  return bent;
}

float chosen_curvature(Bent bent)
{
#if defined(GAUSSIAN)
  return bent.mean * bent.mean - bent.spread * bent.spread;
#elif defined(MEAN)
  return bent.mean;
#elif defined(STRONGEST)
  return abs(bent.mean) + bent.spread;
#elif defined(LARGEST)
  return bent.mean + bent.spread;
#else
  return bent.mean - bent.spread;
#endif
}

#ifdef DIRECTIONS
vec2 on_screen(vec3 point)
{
  vec4 clip = view.view_to_clip * (view.world_to_view * vec4(point, 1.0));
  return (0.5 * clip.xy / clip.w + 0.5) * vec2(textureSize(seen_color, 0));
}

// How much of a pixel `offset` away from a stroke's middle is on it; `along` reaches to the stroke's end.
float on_stroke(vec2 offset, vec2 along, float radius)
{
  float reach = max(length(along), 1e-3);
  vec2 direction = along / reach;
  float beside = abs(offset.x * direction.y - offset.y * direction.x);
  float beyond = max(abs(dot(offset, direction)) - reach, 0.0);
  return clamp(radius + 0.5 - length(vec2(beside, beyond)), 0.0, 1.0);
}

vec3 with_strokes(vec3 rgb, ivec2 pixel, float number)
{
  ivec2 size = textureSize(seen_color, 0);
  ivec2 center = (pixel / CELL) * CELL + CELL / 2;
  if (any(greaterThanEqual(center, size))) {
    return rgb;
  }
  MirrorPixel middle = mirror_pixel(center);
  Bent bent = bent_at(center, middle.number);
  // Where all directions bend alike there is none.
  float strongest = abs(bent.mean) + bent.spread;
  if (!middle.is_mirror || middle.number != number || !bent.is_known || bent.spread < 0.01 * strongest) {
    return rgb;
  }
  // A tangent's part along the smaller direction vanishes in (S - k2) t: of two tangents that which keeps more.
  vec3 n = middle.normal;
  vec3 first = normalize(abs(n.z) < 0.9 ? cross(n, vec3(0.0, 0.0, 1.0)) : cross(n, vec3(1.0, 0.0, 0.0)));
  vec3 second = cross(n, first);
  float smaller = bent.mean - bent.spread;
  vec3 one = bent.tensor * first - smaller * first;
  vec3 other = bent.tensor * second - smaller * second;
  vec3 outwards = normalize(dot(one, one) > dot(other, other) ? one : other);
  vec3 inwards = cross(n, outwards);
  vec4 clip = view.view_to_clip * (view.world_to_view * vec4(middle.point, 1.0));
  float pixel_size = 2.0 * clip.w / (view.view_to_clip[1][1] * float(size.y));
  vec2 place = vec2(center) + 0.5;
  vec2 offset = vec2(pixel) + 0.5 - place;
  vec2 most = on_screen(middle.point + STROKE.x * pixel_size * outwards) - on_screen(middle.point);
  vec2 least = on_screen(middle.point + 0.6 * STROKE.x * pixel_size * inwards) - on_screen(middle.point);
  rgb = mix(rgb, vec3(0.95), on_stroke(offset, least, STROKE.y));
  return mix(rgb, vec3(0.01), on_stroke(offset, most, STROKE.y));
}
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  MirrorPixel at = mirror_pixel(pixel);
  Bent bent = bent_at(pixel, at.number);
  float place = clamp((chosen_curvature(bent) - range.x) / (range.y - range.x), 0.0, 1.0);
  vec2 texels = vec2(textureSize(ramp, 0));
  vec3 rgb = texture(ramp, vec2((place * (texels.x - 1.0) + 0.5) / texels.x, 0.5)).rgb;
  rgb = bent.is_known ? rgb : background;
#ifdef DIRECTIONS
  rgb = with_strokes(rgb, pixel, at.number);
#endif
  color = opacity * premultiplied(rgb, at);
}
