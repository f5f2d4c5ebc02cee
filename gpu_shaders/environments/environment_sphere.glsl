// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sphere map: the picture of a mirror ball as seen from far away along `environment_axis` (COMP 557, lecture 18).
// Needs the sampler `environment` (FLOAT_2D) and the push constants `environment_right`, `environment_up` and
// `environment_axis`, an orthonormal frame.

vec3 environment_direction(vec3 point, vec3 ray)
{
  return ray;
}

vec4 environment_at(vec3 point, vec3 ray)
{
  vec3 r = vec3(dot(environment_right, ray), dot(environment_up, ray), dot(environment_axis, ray));
  float size = length(vec3(r.xy, r.z + 1.0));
  // The direction away from the eye is all of the rim.
  vec2 place = size > 1e-6 ? r.xy / size : vec2(1.0, 0.0);
  return textureLod(environment, 0.5 * place + 0.5, 0.0);
}
