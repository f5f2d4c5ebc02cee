// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices between the solved corners of their mesh's bounding grid (Estalella et al. 2005, section 5): virtual positions
// and reflection points by trilinear interpolation with the local coordinates (u, v, w) in a cell.
#include "common/status.glsl"
#include "common/invocation.glsl"
#include "common/records.glsl"
#include "common/vectors.glsl"

// Record i of cells: local (u, v, w) and the index of the cell's first corner in `corner_numbers`.
void main()
{
  int index = invocation();
  if (index >= count) {
    return;
  }
  ivec2 texel = texel_of_record(index);
  if (!is_finite(fetch_record(positions, index).xyz)) {
    imageStore(reflection_points, texel, vec4(vec3(0.0), float(INVALID)));
    imageStore(virtual_positions, texel, vec4(0.0));
    return;
  }
  vec4 cell = fetch_record(cells, index);
  ivec4 low = ivec4(fetch_record(corner_numbers, 2 * int(cell.w + 0.5)) + 0.5);
  ivec4 high = ivec4(fetch_record(corner_numbers, 2 * int(cell.w + 0.5) + 1) + 0.5);
  vec3 point = vec3(0.0);
  vec4 seeming = vec4(0.0);
  float reflected = 0.0;
  int iterations = 0;
  bool failed = false;
  for (int k = 0; k < 8; k++) {
    vec3 weights = mix(1.0 - cell.xyz, cell.xyz, vec3(k & 1, (k >> 1) & 1, k >> 2));
    float weight = weights.x * weights.y * weights.z;
    int corner = k < 4 ? low[k] : high[k - 4];
    vec4 solved = fetch_record(grid_points, corner);
    int code = int(solved.w + 0.5);
    failed = failed || (code & 3) >= UNSOLVED;
    reflected += (code & 3) == REFLECTED ? weight : 0.0;
    iterations = max(iterations, code >> 2);
    point += weight * solved.xyz;
    seeming += weight * fetch_record(grid_virtual, corner);
  }
  int status = failed ? UNSOLVED : reflected > 0.5 ? REFLECTED : HIDDEN;
  imageStore(reflection_points, texel, vec4(point, float(status + 4 * iterations)));
  imageStore(virtual_positions, texel, seeming);
}
