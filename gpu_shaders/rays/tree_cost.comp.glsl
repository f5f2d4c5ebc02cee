// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the surface-area heuristic expects of a hierarchy, times half the root's area (`Hierarchy.cost`), in SUMS parts
// to be added up; the last number of the first part is half the root's area. `nodes`: first record, how many.
#include "common/invocation.glsl"
#include "common/records.glsl"

float half_area(vec3 low, vec3 high)
{
  vec3 size = high - low;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

void main()
{
  int index = invocation();
  if (index >= SUMS) {
    return;
  }
  float sum = 0.0;
  for (int number = index; number < nodes.y; number += SUMS) {
    int node = nodes.x + NODE_RECORDS * number;
    for (int k = 0; k < NODE_RECORDS; k += 2) {
      vec4 high = fetch_record(rays, node + k + 1);
      sum += half_area(fetch_record(rays, node + k).xyz, high.xyz) * (high.w > 0.0 ? high.w : 2.0);
    }
  }
  vec3 low = min(fetch_record(rays, nodes.x).xyz, fetch_record(rays, nodes.x + 2).xyz);
  vec3 high = max(fetch_record(rays, nodes.x + 1).xyz, fetch_record(rays, nodes.x + 3).xyz);
  imageStore(sums, texel_of_record(index), vec4(sum, 0.0, 0.0, index == 0 ? half_area(low, high) : 0.0));
}
