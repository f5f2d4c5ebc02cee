// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Sky Texture: a port of kernel/svm/sky.h of Cycles. `first`: of its records (scene/programs/nodes/skies.py).
//   0..2: rows from XYZ to the working space
//   skies by their numbers: 3: the sun's angle to the zenith and to the Y axis; 4: radiances; 5..: coefficients
//   scattered light: 3: elevation, rotation, angular diameter and intensity of the sun; 4, 5: XYZ at its lowest point,
//   with the elevation below which the earth hides it, and at its highest; 6..: the table, row by row
#include "common/records.glsl"

#define SKY_PI 3.14159265358979
#define SKY_ROWS 256
#define SKY_HALF_COLUMNS 256

vec3 sky_color(int first, vec3 xyz)
{
  return max(vec3(dot(fetch_record(program_records, first).xyz, xyz),
                  dot(fetch_record(program_records, first + 1).xyz, xyz),
                  dot(fetch_record(program_records, first + 2).xyz, xyz)), 0.0);
}

float sky_azimuth(vec3 direction)
{
  return direction.x == 0.0 && direction.y == 0.0 ? 0.0 : atan(direction.y, direction.x);
}

// Angles to the zenith (not below the horizon) and to the sun.
vec2 sky_angles(int first, vec3 direction)
{
  vec2 sun = fetch_record(program_records, first + 3).xy;
  float theta = acos(clamp(direction.z, -1.0, 1.0));
  float turn = 0.5 * SKY_PI - sky_azimuth(direction);
  float cosine = sin(theta) * sin(sun.x) * cos(sun.y - turn) + cos(theta) * cos(sun.x);
  return vec2(min(theta, 0.5 * SKY_PI - 0.001), acos(clamp(cosine, -1.0, 1.0)));
}

vec3 sky_preetham(int first, vec3 direction)
{
  vec2 angles = sky_angles(first, direction);
  vec3 a = fetch_record(program_records, first + 5).xyz, b = fetch_record(program_records, first + 6).xyz;
  vec3 c = fetch_record(program_records, first + 7).xyz, d = fetch_record(program_records, first + 8).xyz;
  vec3 e = fetch_record(program_records, first + 9).xyz;
  float cosine = cos(angles.y);
  vec3 found = fetch_record(program_records, first + 4).xyz * (1.0 + a * exp(b / cos(angles.x))) *
               (1.0 + c * exp(d * angles.y) + e * cosine * cosine);
  float x = found.y, y = found.z;
  vec3 xyz = y == 0.0 ? vec3(0.0, found.x, 0.0) : vec3(x, y, 1.0 - x - y) * (found.x / y);
  return sky_color(first, xyz);
}

vec3 sky_hosek(int first, vec3 direction)
{
  vec2 angles = sky_angles(first, direction);
  vec3 c[9];
  for (int k = 0; k < 9; k++) {
    c[k] = fetch_record(program_records, first + 5 + k).xyz;
  }
  float up = cos(angles.x), cosine = cos(angles.y);
  float square = cosine * cosine;
  vec3 by_dust = (1.0 + square) / pow(1.0 + c[8] * c[8] - 2.0 * c[8] * cosine, vec3(1.5));
  vec3 xyz = (1.0 + c[0] * exp(c[1] / (up + 0.01))) *
             (c[2] + c[3] * exp(c[4] * angles.y) + c[5] * square + c[6] * by_dust + c[7] * sqrt(up));
  return sky_color(first, xyz * fetch_record(program_records, first + 4).xyz) * (2.0 * SKY_PI / 683.0);
}

vec3 sky_texel(int first, int column, int row)
{
  column = clamp(column, 0, 2 * SKY_HALF_COLUMNS - 1);
  row = clamp(row, 0, SKY_ROWS - 1);
  int half_column = column < SKY_HALF_COLUMNS ? column : 2 * SKY_HALF_COLUMNS - 1 - column;
  return fetch_record(program_records, first + 6 + SKY_HALF_COLUMNS * row + half_column).xyz;
}

// `apart`: the sun is left to whoever draws it, where PROGRAM_WITHOUT_SUNS is defined.
vec3 sky_scattered(int first, vec3 direction, bool apart)
{
  vec4 sun = fetch_record(program_records, first + 3);
  float elevation = 0.5 * SKY_PI - acos(clamp(direction.z, -1.0, 1.0));
  float azimuth = sky_azimuth(direction);
  float x = fract((-azimuth - 0.5 * SKY_PI + sun.y) / (2.0 * SKY_PI)) * float(2 * SKY_HALF_COLUMNS) - 0.5;
  float level = sqrt(abs(elevation) * (2.0 / SKY_PI));
  float y = ((elevation < 0.0 ? -level : level) * 0.5 + 0.5) * float(SKY_ROWS) - 0.5;
  int column = int(floor(x)), row = int(floor(y));
  float s = x - floor(x), t = y - floor(y);
  vec3 low = mix(sky_texel(first, column, row), sky_texel(first, column + 1, row), s);
  vec3 high = mix(sky_texel(first, column, row + 1), sky_texel(first, column + 1, row + 1), s);
  vec3 xyz = mix(low, high, t);
  bool has_sun = sun.z >= 0.0;
#ifdef PROGRAM_WITHOUT_SUNS
  has_sun = has_sun && !apart;
#endif
  vec4 lowest = fetch_record(program_records, first + 4);
  vec3 towards = vec3(-cos(sun.x) * sin(sun.y), cos(sun.x) * cos(sun.y), sin(sun.x));
  float angle = 2.0 * atan(length(direction - towards), length(direction + towards));
  float radius = 0.5 * sun.z;
  if (has_sun && angle < radius && elevation > lowest.w) {
    float share = angle / radius;
    float darkened = 1.0 - 0.6 * (1.0 - sqrt(1.0 - share * share));
    vec3 highest = fetch_record(program_records, first + 5).xyz;
    xyz += mix(lowest.xyz, highest, (elevation - sun.x) / sun.z + 0.5) * (sun.w * darkened);
  }
  return sky_color(first, xyz);
}
