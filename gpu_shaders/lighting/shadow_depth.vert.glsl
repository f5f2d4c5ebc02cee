// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/records.glsl"
#ifdef HASHED
#include "common/geometry.glsl"
#include "common/corner_attributes.glsl"
#include "rays/light_through.glsl"
#endif

void main()
{
#ifdef HASHED
  Corner corner = fetch_corner(gl_VertexID);
  int number = light_through_attribute(material);
  uv = number < 0 ? vec2(0.0) : corner_attribute(gl_VertexID, number).xy;
  // (Of a triangle's corners one stands for it.)
  surface = ivec2(gl_VertexID, int(corner.object_id));
  gl_Position = world_to_clip * vec4(corner.position, 1.0);
#else
  gl_Position = world_to_clip * vec4(fetch_record(positions, gl_VertexID).xyz, 1.0);
#endif
}
