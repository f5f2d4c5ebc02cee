// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The scene as the reflector shows it: every vertex where it seems to be (Roger & Holzschuch 2006, section 3.3.5).
#include "common/status.glsl"
#include "common/geometry.glsl"
#ifdef PROGRAM
#include "programs/vertex_attributes.glsl"
#endif

void main()
{
  Corner corner = fetch_corner(gl_VertexID);
  vec4 solved = fetch_record(reflection_points, corner.position_index);
  vec4 seeming = fetch_record(virtual_positions, corner.position_index);
  int code = int(solved.w + 0.5);
  int status = code & 3;
  world_position = corner.position;
  world_normal = corner.normal;
#ifdef PROGRAM
  set_program_inputs(gl_VertexID);
#endif
  object_id = corner.object_id;
  iterations = float(code >> 2);
  reflection_point = solved.xyz;
  rejected = vec2(status >= UNSOLVED ? 1.0 : 0.0, status == HIDDEN ? 1.0 : 0.0);
  gl_Position = view.view_to_clip * (view.world_to_view * vec4(seeming.xyz, 1.0));
  // The fragment writes its own depth; a seeming position past the camera's clip end must not be cut off.
  gl_Position.z = 0.0;
}
