// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of the scene's surfaces (renderer/indirect/cells.py), and what light arrives there. Needs the samplers
// `cell_table` (numbers of patches) and the push constants `cell_grid` (VEC4: focus, half of the side of level 0) and
// `cell_levels` (FLOAT).
#include "common/records.glsl"

// Number of the patch at a place that faces this way; -1 where there is none.
int patch_at(vec3 position, vec3 normal)
{
  vec3 off = position - cell_grid.xyz;
  vec3 far = abs(off);
  float level = ceil(log2(max(max(far.x, max(far.y, far.z)) / cell_grid.w, 1e-30)) - 1e-5);
  level = max(level, 0.0);
  if (!(level < cell_levels)) {
    return -1;
  }
  float per_length = 0.5 * float(CELL_SIDE) / (cell_grid.w * exp2(level));
  ivec3 at = clamp(ivec3(floor(off * per_length + 0.5 * float(CELL_SIDE))), ivec3(0), ivec3(CELL_SIDE - 1));
  vec3 n = abs(normal);
  bool is_x = n.x >= n.y && n.x >= n.z;
  bool is_y = !is_x && n.y >= n.z;
  float along = is_x ? normal.x : (is_y ? normal.y : normal.z);
  int side = (is_x ? 0 : (is_y ? 2 : 4)) + (along < 0.0 ? 1 : 0);
  int number = (((int(level) * 6 + side) * CELL_SIDE + at.z) * CELL_SIDE + at.y) * CELL_SIDE + at.x;
  return int(fetch_record(cell_table, number).x);
}
