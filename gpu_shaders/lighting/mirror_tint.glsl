// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Reflectance of a mirror's material, a number of the sampler `materials`.
#include "lighting/fresnel.glsl"
#include "surfaces/material_records.glsl"
#include "programs/material.glsl"

vec3 mirror_tint(int material, vec3 base_color, float cos_viewer)
{
  vec4 first = fetch_record(materials, MATERIAL_RECORDS * material);
  bool glossy_only = (int(fetch_record(materials, MATERIAL_RECORDS * material + 1).w + 0.5) & KIND_GLOSSY_ONLY) != 0;
  return sharp_reflectance(base_color, first.x, first.z, first.w, glossy_only, cos_viewer);
}
