// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What was looked up at the corners, interpolated; with NEAREST_CORNER the world position and object of the corner
// that counts most, or for the background its direction.
#include "environments/environment_corner.glsl"

void main()
{
  if (texelFetch(mirror_color, ivec2(gl_FragCoord.xy), 0).w != mirror) {
    discard;
  }
#ifdef NEAREST_CORNER
  int place = weights.x >= max(weights.y, weights.z) ? 0 : weights.y >= weights.z ? 1 : 2;
  Corner corner = fetch_corner(int(fetch_record(triangles, triangle)[place] + 0.5));
  color = environment_at_corner(corner);
  color.xyz = color.w > 0.0 ? color.xyz : reflected_ray(corner);
#else
  color = looked_up;
#endif
}
