// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of the scene's surfaces (renderer/indirect/cells.py), and what light arrives there. Needs the samplers
// `cell_table` (numbers of patches, and a half where walls end what one stands for), `patch_walls` (of each patch
// PATCH_WALLS planes: normal towards its points, distance) and the push constants `cell_grid` (VEC4: focus, half of
// the side of level 0) and `cell_levels` (FLOAT).
#include "common/records.glsl"

// Level of a place, below 0 outside of all.
float cell_level(vec3 position)
{
  vec3 far = abs(position - cell_grid.xyz);
  float level = ceil(log2(max(max(far.x, max(far.y, far.z)) / cell_grid.w, 1e-30)) - 1e-5);
  level = max(level, 0.0);
  return level < cell_levels ? level : -1.0;
}

float cell_size(float level)
{
  return 2.0 * cell_grid.w * exp2(level) / float(CELL_SIDE);
}

// Which of +x -x +y -y +z -z a surface faces most.
int cell_side(vec3 normal)
{
  vec3 n = abs(normal);
  bool is_x = n.x >= n.y && n.x >= n.z;
  bool is_y = !is_x && n.y >= n.z;
  float along = is_x ? normal.x : (is_y ? normal.y : normal.z);
  return (is_x ? 0 : (is_y ? 2 : 4)) + (along < 0.0 ? 1 : 0);
}

// The two axes across a side.
void axes_across(int side, out ivec3 first, out ivec3 second)
{
  int along = side / 2;
  first = along == 0 ? ivec3(0, 1, 0) : ivec3(1, 0, 0);
  second = along == 2 ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
}

// In cells from the lowest corner of the level.
vec3 place_in_level(vec3 position, float level)
{
  return (position - cell_grid.xyz) / cell_size(level) + 0.5 * float(CELL_SIDE);
}

// Number of the patch of a cell as far as it stands for a place; -1 where there is none.
int patch_of_cell(ivec3 cell, int side, float level, vec3 position)
{
  if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(CELL_SIDE)))) {
    return -1;
  }
  int number = (((int(level) * 6 + side) * CELL_SIDE + cell.z) * CELL_SIDE + cell.y) * CELL_SIDE + cell.x;
  float entry = fetch_record(cell_table, number).x;
  int found = int(floor(entry));
  if (entry > float(found)) {
    for (int k = 0; k < PATCH_WALLS; k++) {
      vec4 wall = fetch_record(patch_walls, found * PATCH_WALLS + k);
      if (dot(wall.xyz, position) < wall.w) {
        return -1;
      }
    }
  }
  return found;
}

// Number of the patch at a place that faces this way; -1 where there is none.
int patch_at(vec3 position, vec3 normal)
{
  float level = cell_level(position);
  if (level < 0.0) {
    return -1;
  }
  int side = cell_side(normal);
  vec3 place = place_in_level(position, level);
  ivec3 cell = clamp(ivec3(floor(place)), ivec3(0), ivec3(CELL_SIDE - 1));
  int found = patch_of_cell(cell, side, level, position);
  if (found < 0) {
    // Behind a wall in this cell: what the next cells across the surface stand for.
    ivec3 first, second;
    axes_across(side, first, second);
    vec3 off = fract(place) - 0.5;
    ivec3 to_first = first * (dot(off, vec3(first)) < 0.0 ? -1 : 1);
    ivec3 to_second = second * (dot(off, vec3(second)) < 0.0 ? -1 : 1);
    found = patch_of_cell(cell + to_first, side, level, position);
    found = found < 0 ? patch_of_cell(cell + to_second, side, level, position) : found;
  }
  return found;
}

#ifdef SMOOTH_CELLS
// Light of patches around a place, interpolated between the middles of their cells across the surface.
vec3 patches_around(vec3 position, vec3 normal)
{
  float level = cell_level(position);
  if (level < 0.0) {
    return vec3(0.0);
  }
  int side = cell_side(normal);
  vec3 place = place_in_level(position, level) - 0.5;
  ivec3 first = ivec3(floor(place));
  vec3 part = place - vec3(first);
  vec4 sum = vec4(0.0);
  for (int k = 0; k < 8; k++) {
    ivec3 step = ivec3(k & 1, (k >> 1) & 1, k >> 2);
    vec3 weights = mix(1.0 - part, part, vec3(step));
    float weight = weights.x * weights.y * weights.z;
    if (weight > 0.01) {
      int found = patch_of_cell(first + step, side, level, position);
      sum += found < 0 ? vec4(0.0) : weight * vec4(fetch_record(patch_light, found).rgb, 1.0);
    }
  }
  if (sum.w <= 0.0) {
    int found = patch_at(position, normal);
    return found < 0 ? vec3(0.0) : fetch_record(patch_light, found).rgb;
  }
  return sum.rgb / sum.w;
}
#endif
