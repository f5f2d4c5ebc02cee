// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes Map Range and Clamp.
#include "values/math.glsl"

float range_clamp(float value, float low, float high)
{
  return min(max(value, low), high);
}

float range_clamp_ordered(float value, float low, float high)
{
  return range_clamp(value, min(low, high), max(low, high));
}

vec3 range_clamp_ordered(vec3 value, vec3 low, vec3 high)
{
  return min(max(value, min(low, high)), max(low, high));
}

float range_place(float value, float low, float high)
{
  return (value - low) / (high - low);
}

vec3 range_place(vec3 value, vec3 low, vec3 high)
{
  return math_divide(value - low, high - low);
}

float range_stepped(float place, float steps)
{
  return steps > 0.0 ? floor(place * (steps + 1.0)) / steps : 0.0;
}

vec3 range_stepped(vec3 place, vec3 steps)
{
  return vec3(range_stepped(place.x, steps.x), range_stepped(place.y, steps.y), range_stepped(place.z, steps.z));
}

float range_smooth(float place)
{
  float t = clamp(place, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

vec3 range_smooth(vec3 place)
{
  return vec3(range_smooth(place.x), range_smooth(place.y), range_smooth(place.z));
}

float range_smoother(float place)
{
  float t = clamp(place, 0.0, 1.0);
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

vec3 range_smoother(vec3 place)
{
  return vec3(range_smoother(place.x), range_smoother(place.y), range_smoother(place.z));
}

// Numbers (not vectors) are 0 where the range they come from is empty.
float range_mapped(float place, float from_low, float from_high, float low, float high)
{
  return from_low != from_high ? low + place * (high - low) : 0.0;
}
