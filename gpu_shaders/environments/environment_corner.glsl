// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the environment cube has for a corner of the mirror's mesh.
#include "common/geometry.glsl"
#include "environments/environment_cube.glsl"

vec3 reflected_ray(Corner corner)
{
  vec3 incoming = normalize(corner.position * view.eye.w - view.eye.xyz);
  return reflect(incoming, normalize(corner.normal));
}

vec4 environment_at_corner(Corner corner)
{
  return environment_at(corner.position, reflected_ray(corner));
}
