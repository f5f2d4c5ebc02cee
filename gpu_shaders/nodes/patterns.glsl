// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: 2011-2026 Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Wave, Magic, Brick, Checker and Gradient Texture, after Cycles (wave.h, magic.h, brick.h, checker.h, gradient.h).

#define PATTERN_TURN 6.28318530718

// Away from whole numbers, between which rounding decides otherwise.
vec3 pattern_place(vec3 p)
{
  return (p + 0.000001) * 0.999999;
}

// Wave: profiles of what grows along it.

float wave_sin(float along)
{
  return 0.5 + 0.5 * sin(along - 0.25 * PATTERN_TURN);
}

float wave_saw(float along)
{
  return fract(along / PATTERN_TURN);
}

float wave_tri(float along)
{
  along /= PATTERN_TURN;
  return abs(along - floor(along + 0.5)) * 2.0;
}

// Magic. (x is a number with the sign of what it is the remainder of.)

vec3 magic_remainder(vec3 x)
{
  return x - PATTERN_TURN * trunc(x / PATTERN_TURN);
}

vec3 magic_color(vec3 p, float scale, float distortion, int depth)
{
  p = magic_remainder(p * scale);
  float x = sin((p.x + p.y + p.z) * 5.0);
  float y = cos((-p.x + p.y - p.z) * 5.0);
  float z = -cos((-p.x - p.y + p.z) * 5.0);
  if (depth > 0) {
    x *= distortion;
    y *= distortion;
    z *= distortion;
    y = -cos(x - y + z) * distortion;
  }
  if (depth > 1) {
    x = cos(x - y - z) * distortion;
  }
  if (depth > 2) {
    z = sin(-x - y - z) * distortion;
  }
  if (depth > 3) {
    x = -cos(-x + y - z) * distortion;
  }
  if (depth > 4) {
    y = -sin(-x + y + z) * distortion;
  }
  if (depth > 5) {
    y = -cos(-x + y + z) * distortion;
  }
  if (depth > 6) {
    x = cos(x + y + z) * distortion;
  }
  if (depth > 7) {
    z = sin(x + y - z) * distortion;
  }
  if (depth > 8) {
    x = -cos(-x - y + z) * distortion;
  }
  if (depth > 9) {
    y = -sin(x - y + z) * distortion;
  }
  vec3 color = vec3(x, y, z);
  return 0.5 - (distortion != 0.0 ? color / (2.0 * distortion) : color);
}

// Brick

float brick_noise(uint n)
{
  n = (n + 1013u) & 0x7fffffffu;
  n = (n >> 13) ^ n;
  uint mixed = (n * (n * n * 60493u + 19990303u) + 1376312589u) & 0x7fffffffu;
  return 0.5 * (float(mixed) / 1073741824.0);
}

// How much of the second color, how much mortar. `rows`: offset, how often, squash, how often.
vec2 brick_shares(vec3 p, float mortar_size, float mortar_smooth, float bias, float width, float height, vec4 rows)
{
  int row = int(floor(p.y / height));
  // (Whole multiples of either sign.)
  width *= abs(row) % int(rows.w) == 0 ? rows.z : 1.0;
  float along = p.x + (abs(row) % int(rows.y) == 0 ? width * rows.x : 0.0);
  int column = int(floor(along / width));
  float x = along - width * float(column);
  float y = p.y - height * float(row);
  float tint = clamp(brick_noise(uint((row << 16) + (column & 0xFFFF))) + bias, 0.0, 1.0);
  float near = min(min(x, y), min(width - x, height - y));
  float mortar = 0.0;
  if (near < mortar_size) {
    mortar = mortar_smooth == 0.0 ? 1.0 : smoothstep(0.0, 1.0, (1.0 - near / mortar_size) / mortar_smooth);
  }
  return vec2(tint, mortar);
}

vec3 brick_color(vec2 shares, vec3 first, vec3 second, vec3 mortar)
{
  return mix(mix(first, second, shares.x), mortar, shares.y);
}

// Checker

float checker_factor(vec3 p)
{
  ivec3 cell = abs(ivec3(floor(pattern_place(p)))) & 1;
  return (cell.x == cell.y) == (cell.z == 1) ? 1.0 : 0.0;
}

// Gradient: by the node's type.

float gradient_linear(vec3 p)
{
  return clamp(p.x, 0.0, 1.0);
}

float gradient_quadratic(vec3 p)
{
  float r = max(p.x, 0.0);
  return min(r * r, 1.0);
}

float gradient_easing(vec3 p)
{
  return smoothstep(0.0, 1.0, p.x);
}

float gradient_diagonal(vec3 p)
{
  return clamp((p.x + p.y) * 0.5, 0.0, 1.0);
}

float gradient_radial(vec3 p)
{
  // (GLSL's atan has no value at 0.)
  return p.x == 0.0 && p.y == 0.0 ? 0.5 : clamp(atan(p.y, p.x) / PATTERN_TURN + 0.5, 0.0, 1.0);
}

float gradient_spherical(vec3 p)
{
  return max(0.999999 - length(p), 0.0);
}

float gradient_quadratic_sphere(vec3 p)
{
  float r = gradient_spherical(p);
  return r * r;
}
