// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as colors of a ramp: solver iterations, or with ANGLE_ERROR the angle between a pixel's reflected ray and
// the way to what is shown there.
#include "diagnostics/diagnostic_mirror.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  MirrorPixel at = mirror_pixel(pixel);
  vec4 shown = shown_position(pixel, at);
#ifdef ANGLE_ERROR
  vec3 to_shown = shown.xyz - at.point;
  // What is infinitely far away is where its ray goes, unless a lookup goes elsewhere.
  if (shown.w == 0.0) {
#ifdef ENVIRONMENT
    to_shown = environment_direction(at.point, at.ray);
#else
    to_shown = at.ray;
#endif
  }
  // By sine and cosine: the cosine alone does not know small angles.
  float angle = degrees(atan(length(cross(at.ray, to_shown)), dot(at.ray, to_shown)));
  float value = log2(max(angle, 1e-9));
#elif defined(ENVIRONMENT)
  float value = 0.0;
#else
  float value = texelFetch(reflected_color, pixel, 0).w;
#endif
  float place = clamp((value - range.x) / (range.y - range.x), 0.0, 1.0);
  vec2 texels = vec2(textureSize(ramp, 0));
  vec3 rgb = texture(ramp, vec2((place * (texels.x - 1.0) + 0.5) / texels.x, 0.5)).rgb;
#ifndef ANGLE_ERROR
  rgb = shown.w > 0.0 ? rgb : background;
#endif
  color = premultiplied(rgb, at);
}
