// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Every vertex that was searched for, as a point on the mirror where the search ended. A hidden one is where the line
// of sight to it meets the mirror.
#include "common/status.glsl"
#include "common/records.glsl"

void main()
{
  vec4 solved = fetch_record(reflection_points, gl_VertexID);
  int status = int(solved.w + 0.5) & 3;
  reflection_point = solved.xyz;
  length_to_vertex = fetch_record(virtual_positions, gl_VertexID).w;
  vertex_status = float(status);
  gl_PointSize = point_size * (status == REFLECTED ? 1.0 : status == HIDDEN ? 0.7 : 1.6);
  gl_Position = view.view_to_clip * (view.world_to_view * vec4(solved.xyz, 1.0));
  // What went wrong lies over what went right, and that over what the mirror hides.
  gl_Position.z = (status == REFLECTED ? 0.0 : status == HIDDEN ? 0.5 : -0.5) * gl_Position.w;
  if (status == INVALID) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  }
}
