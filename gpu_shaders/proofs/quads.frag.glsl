// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// For renderer/proofs/quads.py. numbers: a value to sum over the quad, the number of an object, a place on a plane.
#include "lighting/quad.glsl"

void main()
{
  vec4 here = texelFetch(numbers, ivec2(gl_FragCoord.xy), 0);
  float sum = quad_sum(vec4(here.x)).x;
  bool joins = quad_is_one_surface(vec3(here.zw, 0.0), vec3(0.0, 0.0, 1.0), vec3(here.y, 0.0, 0.0));
  found = vec4(sum, joins ? 1.0 : 0.0, dFdx(here.z), dFdy(here.w));
}
