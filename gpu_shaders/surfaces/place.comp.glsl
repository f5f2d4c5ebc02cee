// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices and corners of placed meshes into world space, a range of each; records as in renderer/geometry/chunk.py.
#include "common/invocation.glsl"
#include "common/records.glsl"

void place_vertex(int index)
{
  vec4 source = fetch_record(source_positions, index);
  int instance = INSTANCE_RECORDS * int(source.w + 0.5);
  vec4 point = vec4(source.xyz, 1.0);
  vec3 world = vec3(dot(fetch_record(instances, instance), point),
                    dot(fetch_record(instances, instance + 1), point),
                    dot(fetch_record(instances, instance + 2), point));
  imageStore(positions, texel_of_record(index), vec4(world, fetch_record(instances, instance + 6).x));
}

void place_corner(int index)
{
  vec4 first = fetch_record(source_corners, 2 * index);
  vec4 second = fetch_record(source_corners, 2 * index + 1);
  int instance = INSTANCE_RECORDS * int(fetch_record(source_positions, int(first.w + 0.5)).w + 0.5);
  vec3 normal = vec3(dot(fetch_record(instances, instance + 3).xyz, first.xyz),
                     dot(fetch_record(instances, instance + 4).xyz, first.xyz),
                     dot(fetch_record(instances, instance + 5).xyz, first.xyz));
  // As long as it was: normals between two others of a split mesh are shorter and must stay so
  // (renderer/geometry/split.py).
  normal *= length(first.xyz) / max(length(normal), 1e-30);
  imageStore(corners, texel_of_record(2 * index), vec4(normal, first.w));
  imageStore(corners, texel_of_record(2 * index + 1), vec4(second.xyz, fetch_record(instances, instance + 6).y));
}

void main()
{
  int index = invocation();
  if (index < range.y) {
    place_vertex(range.x + index);
  }
  if (index < range.w) {
    place_corner(range.z + index);
  }
}
