// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles that the reflected pass leaves out, about where they would be: a vertex whose search failed is put
// behind the point where the search ended.
#include "common/status.glsl"
#include "common/geometry.glsl"

void main()
{
  Corner corner = fetch_corner(gl_VertexID);
  vec4 solved = fetch_record(reflection_points, corner.position_index);
  vec4 seeming = fetch_record(virtual_positions, corner.position_index);
  int status = int(solved.w + 0.5) & 3;
  vec3 place = seeming.xyz;
  if (status == UNSOLVED) {
    place = solved.xyz - seeming.w * normalize(view.eye.xyz - solved.xyz * view.eye.w);
  }
  // A triangle with a vertex that is no number cannot be placed at all.
  failed = vec2(status == UNSOLVED ? 1.0 : 0.0, status == INVALID ? 1.0 : 0.0);
  gl_Position = view.view_to_clip * (view.world_to_view * vec4(place, 1.0));
  gl_Position.z = -0.1 * gl_Position.w;
}
