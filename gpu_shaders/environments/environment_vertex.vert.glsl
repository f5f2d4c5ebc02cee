// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A mirror's mesh with the environment looked up at its corners. With NEAREST_CORNER every triangle has three vertices
// of its own, in order, and the fragments look up.
#include "environments/environment_corner.glsl"

void main()
{
#ifdef NEAREST_CORNER
  triangle = gl_VertexID / 3;
  int place = gl_VertexID - 3 * triangle;
  weights = vec3(place == 0, place == 1, place == 2);
  Corner corner = fetch_corner(int(fetch_record(triangles, triangle)[place] + 0.5));
#else
  Corner corner = fetch_corner(gl_VertexID);
  looked_up = environment_at_corner(corner);
#endif
  // Multiplied as the primary pass does it, so that the same surface is in front.
  gl_Position = view.view_to_clip * (view.world_to_view * vec4(corner.position, 1.0));
}
