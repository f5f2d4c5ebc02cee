// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "lighting/mirror_tint.glsl"

vec3 tint_at(ivec2 pixel)
{
  vec4 facing = texelFetch(seen_normal, pixel, 0);
  vec3 incoming = normalize(texelFetch(seen_position, pixel, 0).xyz * view.eye.w - view.eye.xyz);
  return mirror_tint(int(floor(facing.w + 0.5)), texelFetch(seen_color, pixel, 0).rgb,
                     max(-dot(facing.xyz, incoming), 0.0));
}
