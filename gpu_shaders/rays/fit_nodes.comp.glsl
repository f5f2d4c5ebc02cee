// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of one level of a hierarchy: the boxes of those children that are nodes themselves, which have been fitted
// before (records as in rays/ray_walk.glsl). `nodes`: first record of the hierarchy's; first node, how many.
#include "common/invocation.glsl"
#include "common/records.glsl"

vec4 record_of(int index)
{
  return imageLoad(rays, texel_of_record(index));
}

void main()
{
  int index = invocation();
  if (index >= nodes.z) {
    return;
  }
  int node = nodes.x + NODE_RECORDS * (nodes.y + index);
  for (int k = 0; k < NODE_RECORDS; k += 2) {
    if (record_of(node + k + 1).w == 0.0) {
      float link = record_of(node + k).w;
      int child = nodes.x + NODE_RECORDS * int(link);
      vec3 low = min(record_of(child).xyz, record_of(child + 2).xyz);
      vec3 high = max(record_of(child + 1).xyz, record_of(child + 3).xyz);
      imageStore(rays, texel_of_record(node + k), vec4(low, link));
      imageStore(rays, texel_of_record(node + k + 1), vec4(high, 0.0));
    }
  }
}
