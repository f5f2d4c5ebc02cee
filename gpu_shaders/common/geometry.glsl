// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Vertex fetch from the record textures of renderer/geometry.py.
// Needs the samplers (FLOAT_2D) `positions` and `corners`.

#include "common/records.glsl"

struct Corner {
  vec3 position;  // world space
  int position_index;
  float object_id;
  vec3 normal;
  float mirror;  // 1, 2, ... on a reflector
};

Corner fetch_corner(int index)
{
  vec4 first = fetch_record(corners, 2 * index);
  vec4 second = fetch_record(corners, 2 * index + 1);
  Corner corner;
  corner.position_index = int(first.w + 0.5);
  vec4 place = fetch_record(positions, corner.position_index);
  corner.position = place.xyz;
  corner.object_id = place.w;
  corner.normal = first.xyz;
  corner.mirror = second.w;
  return corner;
}
