// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that change colors.
#include "values/color_models.glsl"

vec3 color_hue_saturation(vec3 color, float hue, float saturation, float value, float factor)
{
  vec3 hsv = color_to_hsv(color);
  hsv = vec3(fract(hsv.x + hue + 0.5), clamp(hsv.y * saturation, 0.0, 1.0), hsv.z * value);
  return max(factor * color_from_hsv(hsv) + (1.0 - factor) * color, 0.0);
}

vec3 color_bright_contrast(vec3 color, float bright, float contrast)
{
  return max((1.0 + contrast) * color + (bright - 0.5 * contrast), 0.0);
}

vec3 color_gamma(vec3 color, float gamma)
{
  if (gamma == 0.0) {
    return vec3(1.0);
  }
  return vec3(color.x > 0.0 ? pow(color.x, gamma) : color.x, color.y > 0.0 ? pow(color.y, gamma) : color.y,
              color.z > 0.0 ? pow(color.z, gamma) : color.z);
}

vec3 color_inverted(vec3 color, float factor)
{
  return factor * (1.0 - color) + (1.0 - factor) * color;
}
