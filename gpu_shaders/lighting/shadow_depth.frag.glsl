// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Depth of a shadow caster, moved away from the light by what its plane sinks over bias.x texels in x and in y, so
// that a comparison with a texel beside the point does not shade the surface by itself. Depth in the window is affine
// in the window's x and y on a plane, in perspective too, so this is exact. The move is at most bias.y + bias.z (1 -
// depth).
#ifdef HASHED
#include "common/hash.glsl"
#include "rays/light_through.glsl"

// 0..1, of this texel of this surface. `turn`: which of how many maps; the numbers of up to TOGETHER of them in a row
// are one in each of as many equal parts, in an order of the texel's own, so that surfaces one behind the other are
// there independently.
#define TOGETHER 16

float chance()
{
  int count = min(turn.y, TOGETHER);
  uint seed = hashed(uint(gl_FragCoord.x) | (uint(gl_FragCoord.y) << 16));
  seed = hashed(seed ^ uint(surface.x));
  seed = hashed(seed + uint(surface.y));
  seed = hashed(seed + uint(turn.x / count));
  uint own = hashed(seed + uint(turn.x % count));
  int rank = 0;
  for (int other = 0; other < count; other++) {
    rank += hashed(seed + uint(other)) < own ? 1 : 0;
  }
  return (float(rank) + float(seed >> 8) / 16777216.0) / float(count);
}
#endif

void main()
{
  float depth = gl_FragCoord.z;
  float slope = bias.x * (abs(dFdx(depth)) + abs(dFdy(depth)));
#ifdef HASHED
  if (chance() < dot(light_through(material, uv), vec3(1.0 / 3.0))) {
    discard;
  }
#endif
  gl_FragDepth = depth + min(slope, bias.y + bias.z * (1.0 - depth));
}
