// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0): `bsdf_principled_hair_chiang.h` of Cycles
// SPDX-License-Identifier: GPL-3.0-or-later

float hair_roughness_scale(float rough)
{
  return (((((0.245 * rough + 5.574) * rough - 10.73) * rough + 2.532) * rough - 0.215) * rough) + 5.969;
}

// What a bundle of hair reflects that absorbs so much.
vec3 hair_color(vec3 absorption, float rough)
{
  return exp(-sqrt(max(absorption, 0.0)) * hair_roughness_scale(rough));
}

// `melanin`, `redness`: from 0 to 1.
vec3 melanin_color(float melanin, float redness, vec3 tint, float rough)
{
  float amount = -log(max(1.0 - melanin, 0.0001));
  vec3 absorption = amount * mix(vec3(0.506, 0.841, 1.653), vec3(0.343, 0.733, 1.924), redness);
  vec3 added = log(max(tint, 1e-5)) / hair_roughness_scale(rough);
  return hair_color(absorption + added * added, rough);
}
