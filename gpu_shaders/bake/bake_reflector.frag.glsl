// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Position and shading normal of a mesh in the map frame. w: 1 on the outside of a triangle, -1 on its inside.
void main()
{
  // Seen from inside, the outside of a triangle is the one that turns its back.
  bool outside = gl_FrontFacing == (inverted == 1);
  if (outside_only == 1 && !outside) {
    discard;
  }
  float facing = outside ? 1.0 : -1.0;
  hit_position = vec4(map_position, facing);
  hit_normal = vec4(map_normal, facing);
  gl_FragDepth = min(length(map_position) / depth_range, 1.0);
}
