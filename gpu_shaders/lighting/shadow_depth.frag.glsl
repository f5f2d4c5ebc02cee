// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Depth of a shadow caster, moved away from the light by what its plane sinks over bias.x texels in x and in y, so
// that a comparison with a texel beside the point does not shade the surface by itself. Depth in the window is affine
// in the window's x and y on a plane, in perspective too, so this is exact. The move is at most bias.y + bias.z (1 -
// depth).
void main()
{
  float depth = gl_FragCoord.z;
  float slope = bias.x * (abs(dFdx(depth)) + abs(dFdy(depth)));
  gl_FragDepth = depth + min(slope, bias.y + bias.z * (1.0 - depth));
}
