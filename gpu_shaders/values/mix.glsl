// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Blend types of the node Mix: color `b` over `a` by a factor `t`.
#include "values/color_models.glsl"

vec3 mix_mix(vec3 a, vec3 b, float t)
{
  return (1.0 - t) * a + t * b;
}

vec3 mix_add(vec3 a, vec3 b, float t)
{
  return a + t * b;
}

vec3 mix_multiply(vec3 a, vec3 b, float t)
{
  return a * (1.0 - t + t * b);
}

vec3 mix_screen(vec3 a, vec3 b, float t)
{
  return 1.0 - (1.0 - t + t * (1.0 - b)) * (1.0 - a);
}

float mix_overlay(float a, float b, float t)
{
  return a < 0.5 ? a * (1.0 - t + 2.0 * t * b) : 1.0 - (1.0 - t + 2.0 * t * (1.0 - b)) * (1.0 - a);
}

vec3 mix_overlay(vec3 a, vec3 b, float t)
{
  return vec3(mix_overlay(a.x, b.x, t), mix_overlay(a.y, b.y, t), mix_overlay(a.z, b.z, t));
}

vec3 mix_subtract(vec3 a, vec3 b, float t)
{
  return a - t * b;
}

float mix_divide(float a, float b, float t)
{
  return b != 0.0 ? (1.0 - t) * a + t * a / b : a;
}

vec3 mix_divide(vec3 a, vec3 b, float t)
{
  return vec3(mix_divide(a.x, b.x, t), mix_divide(a.y, b.y, t), mix_divide(a.z, b.z, t));
}

vec3 mix_difference(vec3 a, vec3 b, float t)
{
  return a + t * (abs(a - b) - a);
}

vec3 mix_exclusion(vec3 a, vec3 b, float t)
{
  return max(a + t * (b - 2.0 * a * b), 0.0);
}

vec3 mix_darken(vec3 a, vec3 b, float t)
{
  return a + t * (min(a, b) - a);
}

vec3 mix_lighten(vec3 a, vec3 b, float t)
{
  return a + t * (max(a, b) - a);
}

float mix_dodge(float a, float b, float t)
{
  float left = 1.0 - t * b;
  return a == 0.0 ? 0.0 : (left <= 0.0 ? 1.0 : min(a / left, 1.0));
}

vec3 mix_dodge(vec3 a, vec3 b, float t)
{
  return vec3(mix_dodge(a.x, b.x, t), mix_dodge(a.y, b.y, t), mix_dodge(a.z, b.z, t));
}

float mix_burn(float a, float b, float t)
{
  float part = 1.0 - t + t * b;
  return part <= 0.0 ? 0.0 : clamp(1.0 - (1.0 - a) / part, 0.0, 1.0);
}

vec3 mix_burn(vec3 a, vec3 b, float t)
{
  return vec3(mix_burn(a.x, b.x, t), mix_burn(a.y, b.y, t), mix_burn(a.z, b.z, t));
}

vec3 mix_soft_light(vec3 a, vec3 b, float t)
{
  vec3 screen = 1.0 - (1.0 - b) * (1.0 - a);
  return (1.0 - t) * a + t * ((1.0 - a) * b * a + a * screen);
}

vec3 mix_linear_light(vec3 a, vec3 b, float t)
{
  return a + t * (2.0 * b - 1.0);
}

// Hues are not mixed: the colors are.
vec3 mix_hue(vec3 a, vec3 b, float t)
{
  vec3 second = color_to_hsv(b);
  vec3 first = color_to_hsv(a);
  return second.y != 0.0 ? a + t * (color_from_hsv(vec3(second.x, first.yz)) - a) : a;
}

vec3 mix_color(vec3 a, vec3 b, float t)
{
  vec3 second = color_to_hsv(b);
  return second.y != 0.0 ? a + t * (color_from_hsv(vec3(second.xy, color_to_hsv(a).z)) - a) : a;
}

vec3 mix_saturation(vec3 a, vec3 b, float t)
{
  vec3 first = color_to_hsv(a);
  float saturation = (1.0 - t) * first.y + t * color_to_hsv(b).y;
  return first.y != 0.0 ? color_from_hsv(vec3(first.x, saturation, first.z)) : a;
}

vec3 mix_value(vec3 a, vec3 b, float t)
{
  vec3 first = color_to_hsv(a);
  return color_from_hsv(vec3(first.xy, (1.0 - t) * first.z + t * color_to_hsv(b).z));
}
