// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A direction between eye and vertex to start from; mirrors `guess` of optics/newton.py.
#include "vectors.glsl"

vec3 guess_between(vec4 eye, vec3 vertex)
{
  vec3 a = safe_unit(eye.xyz);
  vec3 b = safe_unit(vertex);
  float distance_to_eye = length(eye.xyz);
  float share = eye.w > 0.0 ? distance_to_eye / (distance_to_eye + length(vertex)) : 1.0;
  float cosine = clamp(dot(a, b), -1.0, 1.0);
  vec3 across = b - cosine * a;
  if (length(across) < 1e-6) {
    vec3 other;
    tangent_frame(a, across, other);
  }
  // Not acos: near 0 and pi it loses half the digits.
  float angle = share * atan(length(b - cosine * a), cosine);
  return cos(angle) * a + sin(angle) * safe_unit(across);
}
