// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices between the solved corners of their mesh's bounding grid (Estalella et al. 2005, section 5): virtual
// positions and reflection points by trilinear interpolation with the local coordinates (u, v, w) in a cell.
#include "solver_pieces/solver.glsl"

// Record i of cells: local (u, v, w) and the index of the cell's first corner in `corner_numbers`.
Solved solve(int index, vec3 vertex)
{
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
  return Solved(status, iterations, point, seeming.xyz, seeming.w);
}
