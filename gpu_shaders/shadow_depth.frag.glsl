// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Depth of a shadow caster, moved away from the light by what its plane sinks over one texel in x and in y, so that
// a bilinear comparison does not shade the surface by itself. Depth in the window is affine in the window's x and y
// on a plane, in perspective too, so this bias is exact. slope_limit: greatest move, constant and per (1 - depth).
void main()
{
  float depth = gl_FragCoord.z;
  float slope = abs(dFdx(depth)) + abs(dFdy(depth));
  gl_FragDepth = depth + min(slope, slope_limit.x + slope_limit.y * (1.0 - depth));
}
