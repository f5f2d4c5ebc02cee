// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Middles of edges: records of `positions` at the two ends that a record of `edges` names.
#include "common/invocation.glsl"
#include "common/records.glsl"

void main()
{
  int index = invocation();
  if (index >= edge_count) {
    return;
  }
  ivec2 ends = ivec2(fetch_record(edges, index).xy + 0.5);
  vec4 first = fetch_record(positions, ends.x);
  vec4 second = fetch_record(positions, ends.y);
  imageStore(middles, texel_of_record(index), vec4(0.5 * (first.xyz + second.xyz), first.w));
}
