// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Finite radius: the environment lies on a ball about the map's center (Bjorke 2004; Roger & Holzschuch 2006,
// section 2). Needs the sampler `environment` (FLOAT_CUBE) and the push constant `environment_ball`: center and
// radius, 0 for infinite.

vec3 environment_direction(vec3 point, vec3 ray)
{
  vec3 place = point - environment_ball.xyz;
  float along = dot(place, ray);
  float root = along * along + environment_ball.w * environment_ball.w - dot(place, place);
  vec3 met = place + (sqrt(max(root, 0.0)) - along) * ray;
  return environment_ball.w > 0.0 ? met : ray;
}

vec4 environment_at(vec3 point, vec3 ray)
{
  return textureLod(environment, environment_direction(point, ray), 0.0);
}
