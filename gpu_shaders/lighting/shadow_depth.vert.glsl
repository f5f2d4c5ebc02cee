// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/records.glsl"
#ifdef HASHED
#include "common/geometry.glsl"
#endif

void main()
{
#ifdef HASHED
  Corner corner = fetch_corner(gl_VertexID);
  uv = corner.uv;
  // (Of a triangle's corners one stands for it.)
  surface = ivec2(gl_VertexID, int(corner.object_id));
  gl_Position = world_to_clip * vec4(corner.position, 1.0);
#else
  gl_Position = world_to_clip * vec4(fetch_record(positions, gl_VertexID).xyz, 1.0);
#endif
}
