// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The leaves of the hierarchy of a mesh that has deformed: records of their triangles, and their boxes into the nodes
// above them (records as in rays/ray_walk.glsl). `leaves`: first triangle, how many, which record of the nodes begins
// the box. `regions`: first records of nodes, triangles and corners; how many leaves. CORNERS_ARE_VERTICES: in their
// order.
#include "common/invocation.glsl"
#include "common/records.glsl"

vec3 place_of_corner(float number)
{
#ifdef CORNERS_ARE_VERTICES
  return fetch_three(mesh_positions, int(number));
#else
  return fetch_three(mesh_positions, int(imageLoad(rays, texel_of_record(regions.z + int(number))).w));
#endif
}

void main()
{
  int index = invocation();
  if (index >= regions.w) {
    return;
  }
  vec4 leaf = fetch_record(leaves, index);
  vec3 low = vec3(3e38);
  vec3 high = vec3(-3e38);
  int triangle = regions.y + TRIANGLE_RECORDS * int(leaf.x);
  for (int k = 0; k < int(leaf.y); k++) {
    vec4 numbers = imageLoad(rays, texel_of_record(triangle + 3));
    vec3 a = place_of_corner(numbers.x);
    vec3 b = place_of_corner(numbers.y);
    vec3 c = place_of_corner(numbers.z);
    imageStore(rays, texel_of_record(triangle), vec4(a, 0.0));
    imageStore(rays, texel_of_record(triangle + 1), vec4(b - a, 0.0));
    imageStore(rays, texel_of_record(triangle + 2), vec4(c - a, 0.0));
    low = min(low, min(a, min(b, c)));
    high = max(high, max(a, max(b, c)));
    triangle += TRIANGLE_RECORDS;
  }
  int box = regions.x + int(leaf.z);
  imageStore(rays, texel_of_record(box), vec4(low, leaf.x));
  imageStore(rays, texel_of_record(box + 1), vec4(high, leaf.y));
}
