// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: 2024-2026 Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Gabor Texture, after Cycles (svm/gabor.h): impulses about each cell of a lattice, summed as complex numbers.
#include "nodes/texture_hash.glsl"

#define GABOR_IMPULSES 8
#define GABOR_PI 3.14159265

// Of one impulse whose square distance is given: real and imaginary part.
vec2 gabor_kernel(float squared, float along)
{
  float height = exp(-GABOR_PI * squared) * (0.5 + 0.5 * cos(GABOR_PI * squared));
  float angle = 2.0 * GABOR_PI * along;
  return height * vec2(cos(angle), sin(angle));
}

vec2 gabor_plane_cell(vec2 cell, vec2 place, float frequency, float isotropy, float orientation)
{
  vec2 sum = vec2(0.0);
  for (int i = 0; i < GABOR_IMPULSES; i++) {
    float number = float(3 * i);
    vec3 seed = vec3(cell, number + 1.0);
    vec2 away = place - vec2(hash_unit(seed), hash_unit(seed.zxy));
    float squared = dot(away, away);
    if (squared >= 1.0) {
      continue;
    }
    float turn = orientation + (hash_unit(vec3(cell, number)) - 0.5) * GABOR_PI * isotropy;
    float weight = hash_unit(vec3(cell, number + 2.0)) < 0.5 ? -1.0 : 1.0;
    sum += weight * gabor_kernel(squared, dot(away, frequency * vec2(cos(turn), sin(turn))));
  }
  return sum;
}

// The direction of an impulse in space, turned by chance.
vec3 gabor_turned(vec3 orientation, float isotropy, vec4 seed)
{
  float azimuth = acos(clamp(orientation.x / length(orientation.xy), -1.0, 1.0));
  azimuth = orientation.y < 0.0 ? -azimuth : azimuth;
  float inclination = acos(clamp(orientation.z, -1.0, 1.0));
  vec2 turn = vec2(hash_unit(seed), hash_unit(seed.zxwy)) * GABOR_PI * isotropy;
  inclination += turn.x;
  azimuth += turn.y;
  return vec3(sin(inclination) * cos(azimuth), sin(inclination) * sin(azimuth), cos(inclination));
}

vec2 gabor_space_cell(vec3 cell, vec3 place, float frequency, float isotropy, vec3 orientation)
{
  vec2 sum = vec2(0.0);
  for (int i = 0; i < GABOR_IMPULSES; i++) {
    float number = float(3 * i);
    vec3 away = place - hash_color(vec4(cell, number + 1.0));
    float squared = dot(away, away);
    if (squared >= 1.0) {
      continue;
    }
    vec3 direction = orientation;
    if (isotropy != 0.0) {
      direction = gabor_turned(orientation, isotropy, vec4(cell, number));
    }
    float weight = hash_unit(vec4(cell, number + 2.0)) < 0.5 ? -1.0 : 1.0;
    sum += weight * gabor_kernel(squared, dot(away, frequency * direction));
  }
  return sum;
}

// Real and imaginary part, and six standard deviations, by which they are divided.
vec3 gabor_plane(vec2 p, float frequency, float anisotropy, float orientation)
{
  float isotropy = 1.0 - clamp(anisotropy, 0.0, 1.0);
  vec2 cell = floor(p), place = p - cell, sum = vec2(0.0);
  for (int j = -1; j <= 1; j++) {
    for (int i = -1; i <= 1; i++) {
      vec2 offset = vec2(i, j);
      sum += gabor_plane_cell(cell + offset, place - offset, max(frequency, 0.001), isotropy, orientation);
    }
  }
  return vec3(sum, 6.0 * sqrt(float(GABOR_IMPULSES) * 0.5 * 0.25));
}

vec3 gabor_space(vec3 p, float frequency, float anisotropy, vec3 orientation)
{
  float isotropy = 1.0 - clamp(anisotropy, 0.0, 1.0);
  // Along no direction, and about the Z axis by chance, Cycles' values are not numbers, which it draws black: all 0.
  if (orientation == vec3(0.0) || (orientation.xy == vec2(0.0) && isotropy != 0.0)) {
    return vec3(0.0);
  }
  vec3 direction = normalize(orientation);
  vec3 cell = floor(p), place = p - cell;
  vec2 sum = vec2(0.0);
  for (int k = -1; k <= 1; k++) {
    for (int j = -1; j <= 1; j++) {
      for (int i = -1; i <= 1; i++) {
        vec3 offset = vec3(i, j, k);
        sum += gabor_space_cell(cell + offset, place - offset, max(frequency, 0.001), isotropy, direction);
      }
    }
  }
  return vec3(sum, 6.0 * sqrt(float(GABOR_IMPULSES) * 0.5 * 0.17677670));
}

float gabor_value(vec3 phasor)
{
  return phasor.z > 0.0 ? phasor.y / phasor.z * 0.5 + 0.5 : 0.0;
}

float gabor_phase(vec3 phasor)
{
  // (GLSL's atan has no value at 0.)
  float angle = phasor.x == 0.0 && phasor.y == 0.0 ? 0.0 : atan(phasor.y, phasor.x);
  return phasor.z > 0.0 ? (angle + GABOR_PI) / (2.0 * GABOR_PI) : 0.0;
}

float gabor_intensity(vec3 phasor)
{
  return phasor.z > 0.0 ? length(phasor.xy) / phasor.z : 0.0;
}
