// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes Math and Vector Math: what of them is more than an operator of GLSL.

float math_divide(float a, float b)
{
  return b != 0.0 ? a / b : 0.0;
}

vec3 math_divide(vec3 a, vec3 b)
{
  return vec3(math_divide(a.x, b.x), math_divide(a.y, b.y), math_divide(a.z, b.z));
}

float math_power(float a, float b)
{
  if (b == 0.0) {
    return 1.0;
  }
  if (a == 0.0 || (a < 0.0 && b != trunc(b))) {
    return 0.0;
  }
  float size = pow(abs(a), b);
  return a < 0.0 && mod(abs(b), 2.0) != 0.0 ? -size : size;
}

vec3 math_power(vec3 a, vec3 b)
{
  return vec3(math_power(a.x, b.x), math_power(a.y, b.y), math_power(a.z, b.z));
}

float math_logarithm(float a, float base)
{
  return a <= 0.0 || base <= 0.0 ? 0.0 : math_divide(log(a), log(base));
}

float math_inverse_root(float a)
{
  return a > 0.0 ? 1.0 / sqrt(a) : 0.0;
}

// Truncated, as C's fmod.
float math_modulo(float a, float b)
{
  return b != 0.0 ? a - b * trunc(a / b) : 0.0;
}

vec3 math_modulo(vec3 a, vec3 b)
{
  return vec3(math_modulo(a.x, b.x), math_modulo(a.y, b.y), math_modulo(a.z, b.z));
}

float math_floored_modulo(float a, float b)
{
  return b != 0.0 ? a - floor(a / b) * b : 0.0;
}

float math_wrap(float value, float high, float low)
{
  return high != low ? value - (high - low) * floor((value - low) / (high - low)) : low;
}

vec3 math_wrap(vec3 value, vec3 high, vec3 low)
{
  return vec3(math_wrap(value.x, high.x, low.x), math_wrap(value.y, high.y, low.y),
              math_wrap(value.z, high.z, low.z));
}

float math_ping_pong(float a, float b)
{
  return b != 0.0 ? abs(fract((a - b) / (b * 2.0)) * b * 2.0 - b) : 0.0;
}

float math_smooth_minimum(float a, float b, float width)
{
  if (width == 0.0) {
    return min(a, b);
  }
  float h = max(width - abs(a - b), 0.0) / width;
  return min(a, b) - h * h * h * width / 6.0;
}

float math_compare(float a, float b, float width)
{
  return a == b || abs(a - b) <= max(width, 1.1920929e-7) ? 1.0 : 0.0;
}

float math_arc_tangent(float y, float x)
{
  return x == 0.0 && y == 0.0 ? 0.0 : atan(y, x);
}

// (By exponentials: some drivers have poor ones of their own.)
float math_hyperbolic_sine(float a)
{
  return abs(a) < 0.1 ? a * (1.0 + a * a / 6.0 * (1.0 + a * a / 20.0)) : 0.5 * (exp(a) - exp(-a));
}

float math_hyperbolic_tangent(float a)
{
  return sign(a) * (1.0 - 2.0 / (exp(2.0 * abs(a)) + 1.0));
}

vec3 math_normalize(vec3 a)
{
  float size = length(a);
  return size != 0.0 ? a / size : a;
}

vec3 math_project(vec3 a, vec3 b)
{
  float square = dot(b, b);
  return square != 0.0 ? dot(a, b) / square * b : vec3(0.0);
}

vec3 math_face_forward(vec3 a, vec3 incident, vec3 reference)
{
  return dot(reference, incident) < 0.0 ? a : -a;
}
