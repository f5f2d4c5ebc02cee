// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Blinn & Newell 1976: by direction alone, as if everything were infinitely far away.
// Needs the sampler `environment` (FLOAT_CUBE).

vec3 environment_direction(vec3 point, vec3 ray)
{
  return ray;
}

vec4 environment_at(vec3 point, vec3 ray)
{
  return textureLod(environment, ray, 0.0);
}
