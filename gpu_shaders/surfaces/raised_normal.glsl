// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Of the triangle that is drawn. Needs the uniform block `view` and the interpolated `world_position`.
#include "surfaces/reflecting_outward.glsl"

// `normal`: unit, outward.
vec3 raised_normal(vec3 normal)
{
  float side = gl_FrontFacing ? 1.0 : -1.0;
  vec3 to_eye = normalize(view.eye.xyz - world_position * view.eye.w);
  vec3 facing = normalize(cross(dFdx(world_position), dFdy(world_position)));
  facing *= dot(facing, to_eye) < 0.0 ? -1.0 : 1.0;
  return side * reflecting_outward(facing, to_eye, side * normal);
}
