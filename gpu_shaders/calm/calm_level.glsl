// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Texels of the levels that a calm mirror is blurred by: light times the share of the texel that one mirror covers,
// and that mirror's number times two plus the share.

float number_of(vec4 texel)
{
  return floor(0.5 * texel.a);
}

float share_of(vec4 texel)
{
  return texel.a - 2.0 * number_of(texel);
}

vec4 level_texel(vec3 light, float number, float share)
{
  return share > 0.0 ? vec4(light, 2.0 * number + min(share, 1.0)) : vec4(0.0);
}
