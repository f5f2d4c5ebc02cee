// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The corners of a mirror's mesh with their curvature tensors, three records each of `curved`: (x, y, z, 0) in object
// space, and (xx, yy, zz, 0), (xy, xz, yz, 0), which are turned by the rows `turn_x`, `turn_y`, `turn_z`. `place_x`,
// `place_y`, `place_z` are rows of the object's matrix.
#include "common/records.glsl"

void main()
{
  vec4 point = vec4(fetch_record(curved, 3 * gl_VertexID).xyz, 1.0);
  vec3 d = fetch_record(curved, 3 * gl_VertexID + 1).xyz;
  vec3 a = fetch_record(curved, 3 * gl_VertexID + 2).xyz;
  mat3 tensor = mat3(d.x, a.x, a.y, a.x, d.y, a.z, a.y, a.z, d.z);
  // (Its columns are the rows.)
  mat3 turn = mat3(turn_x, turn_y, turn_z);
  mat3 turned = transpose(turn) * tensor * turn;
  diagonal = vec3(turned[0][0], turned[1][1], turned[2][2]);
  across = vec3(turned[0][1], turned[0][2], turned[1][2]);
  vec3 world = vec3(dot(place_x, point), dot(place_y, point), dot(place_z, point));
  gl_Position = view.view_to_clip * (view.world_to_view * vec4(world, 1.0));
#ifdef LINEAR_DEPTH
  // (As primary.vert.glsl.)
  gl_Position.z = -depths.x;
#endif
}
