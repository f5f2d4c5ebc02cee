// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Metals by their complex index of refraction, as a color and a tint of their edges
// (scene/programs/shaders/conductors.py).

// Reflectance of unpolarized light on a conductor.
vec3 conductor_reflectance(vec3 n, vec3 k, float cosine)
{
  float squared = cosine * cosine;
  float sine = 1.0 - squared;
  vec3 difference = n * n - k * k - sine;
  vec3 a2b2 = sqrt(difference * difference + 4.0 * n * n * k * k);
  vec3 a = sqrt(max(0.5 * (a2b2 + difference), 0.0));
  vec3 across = a2b2 + squared;
  vec3 s = (across - 2.0 * cosine * a) / (across + 2.0 * cosine * a);
  vec3 along = squared * a2b2 + sine * sine;
  vec3 p = s * (along - 2.0 * cosine * a * sine) / (along + 2.0 * cosine * a * sine);
  return 0.5 * (s + p);
}

vec3 conductor_color(vec3 n, vec3 k)
{
  return conductor_reflectance(n, k, 1.0);
}

vec3 conductor_edge_tint(vec3 n, vec3 k)
{
  vec3 color = conductor_color(n, k);
  float below = 1.0 - 1.0 / 7.0;
  vec3 schlick = color + (1.0 - color) * (below * below * below * below * below);
  return min(conductor_reflectance(n, k, 1.0 / 7.0) / schlick, 1.0);
}
