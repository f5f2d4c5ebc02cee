// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the eye sees directly.
#include "common/geometry.glsl"
#ifdef PROGRAM
#include "programs/vertex_attributes.glsl"
#endif

void main()
{
  Corner corner = fetch_corner(gl_VertexID);
  world_position = corner.position;
  world_normal = corner.normal;
#ifdef PROGRAM
  set_program_inputs(gl_VertexID);
#endif
  ids = vec2(corner.object_id, corner.mirror);
  // Multiplied in this order: a product made beforehand rounds differently from other passes' depths.
  gl_Position = view.view_to_clip * (view.world_to_view * vec4(corner.position, 1.0));
#ifdef LINEAR_DEPTH
  // Cut off at the near end exactly, and nowhere else: the fragments do the rest.
  gl_Position.z = -depths.x;
#endif
}
