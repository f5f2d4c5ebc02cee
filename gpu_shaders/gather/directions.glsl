// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Directions by chance.
#include "scattering/frame.glsl"

// About +z, as often as their cosine.
vec3 cosine_direction(vec2 random)
{
  float radius = sqrt(random.x);
  float angle = 2.0 * PI * random.y;
  return vec3(radius * cos(angle), radius * sin(angle), sqrt(max(1.0 - random.x, 0.0)));
}
