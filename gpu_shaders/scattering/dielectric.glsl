// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Albedo of a dielectric's lobe, as optics/scattering/layers.py.
#include "scattering/fresnel_layers.glsl"
#include "common/ggx_table.glsl"

// From `f0` to white; `scattering`: multiple scattering in parts of the single one.
vec3 dielectric_albedo(float roughness, float cosine, float eta, vec3 f0, out vec3 scattering)
{
  float real = normal_reflectance(eta);
  float slice = sqrt(sqrt(real)) * float(GGX_IOR_SLICES - 1);
  float below = min(floor(slice), float(GGX_IOR_SLICES - 2));
  vec4 table = ggx_table(roughness, cosine, below);
  float mean_share = clamp((mean_dielectric(eta) - real) / max(1.0 - real, 1e-6), 0.0, 1.0);
  float missing = (1.0 - table.x) / max(table.x, 1e-4);
  scattering = multiple_scattering(mix(f0, vec3(1.0), mean_share), average_albedo(roughness), missing);
  return table.x * scattering * mix(f0, vec3(1.0), mix(table.z, table.w, slice - below));
}

// What a coat lets through of light that comes from below it, but for what it reflects: its tint is of light that goes
// straight through (Beer's law).
vec3 coat_tint_on_way(vec3 tint, float weight, float eta, float cosine)
{
  float way = 1.0 / max(refracted_cosine(cosine, eta), 1e-4);
  return mix(vec3(1.0), pow(max(tint, 1e-10), vec3(way)), min(weight, 1.0));
}
