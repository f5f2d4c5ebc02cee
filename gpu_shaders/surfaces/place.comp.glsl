// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices and corners of placed meshes into world space, a range of each; records as in renderer/geometry/chunk.py.
// By fragments one pass has the vertices, and another (PLACES_CORNERS) the corners. DEFORMED: of one instance, whose
// mesh has deformed (renderer/geometry/vertex_uploads.py).
#include "common/invocation.glsl"

#ifdef DEFORMED
// Object space, and the number of the instance.
vec4 source_of_vertex(int index)
{
  return vec4(fetch_three(mesh_positions, index - range.x), float(deformed_instance));
}

vec3 normal_of_corner(int index)
{
  return fetch_three(mesh_normals, index - range.z);
}

int instance_of_vertex(int index)
{
  return deformed_instance;
}
#else
vec4 source_of_vertex(int index)
{
  return fetch_record(source_positions, index);
}

vec3 normal_of_corner(int index)
{
  return fetch_record(source_corners, 2 * index).xyz;
}

int instance_of_vertex(int index)
{
  return int(fetch_record(source_positions, index).w + 0.5);
}
#endif

vec4 placed_vertex(int index)
{
  vec4 source = source_of_vertex(index);
  int instance = INSTANCE_RECORDS * int(source.w + 0.5);
  vec4 point = vec4(source.xyz, 1.0);
  vec3 world = vec3(dot(fetch_record(instances, instance), point),
                    dot(fetch_record(instances, instance + 1), point),
                    dot(fetch_record(instances, instance + 2), point));
  return vec4(world, fetch_record(instances, instance + 6).x);
}

// Both records of a corner.
void place_corner(int index, out vec4 first, out vec4 second)
{
  vec3 source = normal_of_corner(index);
  first = fetch_record(source_corners, 2 * index);
  second = fetch_record(source_corners, 2 * index + 1);
  int instance = INSTANCE_RECORDS * instance_of_vertex(int(first.w + 0.5));
  vec3 normal = vec3(dot(fetch_record(instances, instance + 3).xyz, source),
                     dot(fetch_record(instances, instance + 4).xyz, source),
                     dot(fetch_record(instances, instance + 5).xyz, source));
  // As long as it was: normals between two others of a split mesh are shorter and must stay so
  // (renderer/geometry/split.py).
  first.xyz = normal * (length(source) / max(length(normal), 1e-30));
  second.w = fetch_record(instances, instance + 6).y;
}

bool is_in(int index, ivec2 first_and_count)
{
  return index >= first_and_count.x && index < first_and_count.x + first_and_count.y;
}

void main()
{
#ifdef BY_FRAGMENTS
  int record = invocation();
#ifdef PLACES_CORNERS
  if (!is_in(record >> 1, range.zw)) {
    discard;
  }
  vec4 first, second;
  place_corner(record >> 1, first, second);
  corners = (record & 1) == 0 ? first : second;
#else
  if (!is_in(record, range.xy)) {
    discard;
  }
  positions = placed_vertex(record);
#endif
#else
  int vertex = record_from(range.x), corner = record_from(range.z);
  if (is_in(vertex, range.xy)) {
    WRITE_RECORD(positions, vertex, placed_vertex(vertex));
  }
  if (is_in(corner, range.zw)) {
    vec4 first, second;
    place_corner(corner, first, second);
    WRITE_RECORD(corners, 2 * corner, first);
    WRITE_RECORD(corners, 2 * corner + 1, second);
  }
#endif
}
