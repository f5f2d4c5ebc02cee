// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// IES Texture: a port of kernel/util/ies.h of Cycles. `first`: of its records, one number in each: how many angles
// there are about the axis and from it (two numbers), these angles, intensities.
#include "common/records.glsl"

#define IES_PI 3.14159265358979

float ies_number(int first, int number)
{
  return fetch_record(program_records, first + number).x;
}

float ies_cubic(float a, float b, float c, float d, float x)
{
  return 0.5 * (((d + 3.0 * (b - c) - a) * x + (2.0 * a - 5.0 * b + 4.0 * c - d)) * x + (c - a)) * x + b;
}

// The greatest number of `count` ascending ones but the last after which the angle lies.
int ies_place(int first, int count, float angle)
{
  int low = 0, high = count - 1;
  for (int k = 0; k < 20; k++) {
    int middle = (low + high) / 2;
    bool above = ies_number(first, middle) < angle;
    low = above && high - low > 1 ? middle : low;
    high = !above && high - low > 1 ? middle : high;
  }
  return low;
}

// Between the rows v and v + 1 of a column of intensities.
float ies_column(int first, int rows, int v, float between, bvec2 wraps)
{
  float b = ies_number(first, v), c = ies_number(first, v + 1);
  float a = v > 0 ? ies_number(first, max(v - 1, 0)) : (wraps.x ? ies_number(first, 1) : b);
  float d = v + 2 < rows ? ies_number(first, min(v + 2, rows - 1)) : (wraps.y ? ies_number(first, rows - 2) : c);
  return ies_cubic(a, b, c, d, between);
}

float ies_intensity(int first, vec3 vector)
{
  vector = normalize(vector);
  float down = acos(clamp(-vector.z, -1.0, 1.0));
  float about = (vector.x == 0.0 && vector.y == 0.0 ? 0.0 : atan(vector.x, vector.y)) + IES_PI;
  int columns = int(fetch_record(program_records, first).x), rows = int(fetch_record(program_records, first).y);
  int h_first = first + 1, v_first = h_first + columns, values = v_first + rows;
  vec2 h_ends = vec2(ies_number(h_first, 0), ies_number(h_first, columns - 1));
  vec2 v_ends = vec2(ies_number(v_first, 0), ies_number(v_first, rows - 1));
  if (down < v_ends.x || down >= v_ends.y || about < h_ends.x || about >= h_ends.y) {
    return 0.0;
  }
  bool turns = h_ends.x < 1e-7 && h_ends.y > 2.0 * IES_PI - 1e-6;
  bvec2 wraps = bvec2(v_ends.x < 1e-7, v_ends.y > IES_PI - 1e-6);
  int h = ies_place(h_first, columns, about), v = ies_place(v_first, rows, down);
  float h_low = ies_number(h_first, h), v_low = ies_number(v_first, v);
  float h_between = (about - h_low) / max(ies_number(h_first, h + 1) - h_low, 1e-12);
  float v_between = (down - v_low) / max(ies_number(v_first, v + 1) - v_low, 1e-12);
  float b = ies_column(values + h * rows, rows, v, v_between, wraps);
  float c = ies_column(values + (h + 1) * rows, rows, v, v_between, wraps);
  int before = h > 0 ? h - 1 : columns - 2, after = h + 2 < columns ? h + 2 : 1;
  float a = h > 0 || turns ? ies_column(values + before * rows, rows, v, v_between, wraps) : b;
  float d = h + 2 < columns || turns ? ies_column(values + after * rows, rows, v, v_between, wraps) : b;
  return max(ies_cubic(a, b, c, d, h_between), 0.0);
}
