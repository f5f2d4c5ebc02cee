// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The mirror at this pixel. Needs the uniform block `view` and the samplers `seen_position`, `seen_normal`,
// `seen_color`; with SHOWS_SCENE the sampler `reflected_position`, or with ENVIRONMENT `environment` (world position
// and object), its lookup `environment_at` and `mirror`.

struct MirrorPixel {
  bool is_mirror;  // covered as in the shade pass
  float number;
  vec3 point;
  vec3 normal;
  vec3 ray;  // this pixel's own reflected ray, unit
};

MirrorPixel mirror_pixel(ivec2 pixel)
{
  vec4 position = texelFetch(seen_position, pixel, 0);
  vec3 incoming = normalize(position.xyz * view.eye.w - view.eye.xyz);
  MirrorPixel found;
  found.number = texelFetch(seen_color, pixel, 0).w;
  found.is_mirror = position.w > 0.0 && found.number > 0.5;
  found.point = position.xyz;
  found.normal = texelFetch(seen_normal, pixel, 0).xyz;
  found.ray = found.is_mirror ? reflect(incoming, found.normal) : vec3(0.0, 0.0, 1.0);
#ifdef ENVIRONMENT
  // One pass per mirror.
  found.is_mirror = found.is_mirror && abs(found.number - mirror) < 0.5;
#endif
  return found;
}

#ifdef SHOWS_SCENE
// World point that the mirror shows here, and its object: 0 for the background.
vec4 shown_position(ivec2 pixel, MirrorPixel at)
{
#ifdef ENVIRONMENT
  return environment_at(at.point, at.ray);
#else
  return texelFetch(reflected_position, pixel, 0);
#endif
}
#endif
