// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of color ramps and curves: RAMP_ROWS records of `program_records` from `first` on. Needs `fetch_record`.
#include "common/records.glsl"
#from scene.programs.nodes.values.tables import RAMP_ROWS

int ramp_row(float place)
{
  return clamp(int(clamp(place, 0.0, 1.0) * float(RAMP_ROWS - 1)), 0, RAMP_ROWS - 1);
}

vec4 ramp_constant(int first, float place)
{
  return fetch_record(program_records, first + ramp_row(place));
}

vec4 ramp_linear(int first, float place)
{
  int row = ramp_row(place);
  float part = clamp(place, 0.0, 1.0) * float(RAMP_ROWS - 1) - float(row);
  vec4 found = fetch_record(program_records, first + row);
  // (There is no row after the last.)
  return part > 0.0 ? (1.0 - part) * found + part * fetch_record(program_records, first + row + 1) : found;
}

// Beyond its ends it goes on straight.
vec4 ramp_extended(int first, float place)
{
  if (place >= 0.0 && place <= 1.0) {
    return ramp_linear(first, place);
  }
  int end = place < 0.0 ? first : first + RAMP_ROWS - 1;
  int inner = place < 0.0 ? first + 1 : first + RAMP_ROWS - 2;
  vec4 last = fetch_record(program_records, end);
  float beyond = place < 0.0 ? -place : place - 1.0;
  return last + (last - fetch_record(program_records, inner)) * beyond * float(RAMP_ROWS - 1);
}

// `places`: of red, green and blue in curves of their own.
vec3 ramp_curves(int first, vec3 places)
{
  return vec3(ramp_linear(first, places.x).x, ramp_linear(first, places.y).y, ramp_linear(first, places.z).z);
}

vec3 ramp_curves_extended(int first, vec3 places)
{
  return vec3(ramp_extended(first, places.x).x, ramp_extended(first, places.y).y,
              ramp_extended(first, places.z).z);
}

// Of a spectrum in `rows` rows: interpolated, 0 beyond its ends; `place` in rows.
vec3 ramp_spectrum(int first, int rows, float place)
{
  int row = int(place);
  if (row < 0 || row >= rows - 1) {
    return vec3(0.0);
  }
  vec3 low = fetch_record(program_records, first + row).xyz;
  vec3 high = fetch_record(program_records, first + row + 1).xyz;
  return max(low + (place - float(row)) * (high - low), 0.0);
}
