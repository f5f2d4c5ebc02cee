// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A direction between eye and vertex to start from; mirrors `guess` of optics/solvers/descent.py.
#include "common/vectors.glsl"

// Angle from a to b, unit vectors, and the unit tangent at a that leads there.
float arc(vec3 a, vec3 b, out vec3 across)
{
  float cosine = dot(a, b);
  across = b - cosine * a;
  float sine = length(across);
  if (sine < 1e-6) {
    vec3 other;
    tangent_frame(a, across, other);
  }
  across = safe_unit(across);
  // Not acos: near 0 and pi it loses half the digits.
  return atan(sine, cosine);
}

vec3 guess_between(vec4 eye, vec3 vertex)
{
  vec3 a = safe_unit(eye.xyz);
  float distance_to_eye = length(eye.xyz);
  float share = eye.w > 0.0 ? distance_to_eye / (distance_to_eye + length(vertex)) : 1.0;
  vec3 across;
  float angle = share * arc(a, safe_unit(vertex), across);
  return cos(angle) * a + sin(angle) * across;
}
