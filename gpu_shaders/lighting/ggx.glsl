// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The Principled BSDF of Blender 5.2 as far as Curvrefl shades it by lamps and world: one GGX lobe over a Lambertian
// base.

#include "lighting/fresnel.glsl"
#include "common/ggx_table.glsl"

// The surface's lobes towards one viewer.
struct Lobes {
  vec3 diffuse;         // albedo of the Lambertian base, what the lobe above reflects taken off
  vec3 metal_f0;        // Fresnel at normal incidence of the metal, or of a glossy BSDF at every angle
  float metal_edge;     // 1: Schlick towards white at the edge, 0: none
  vec3 metal_weight;    // share of the metal times its multiple scattering
  float dielectric_weight;
  float eta;            // IOR that gives the dielectric its reflectance after "IOR Level"
  float alpha;          // GGX width
  float cos_viewer;
  vec3 specular_albedo; // of the whole lobe: metal and dielectric
};

Lobes lobes_of(Surface s, float cos_viewer)
{
  Lobes lobes;
  float cosine = clamp(cos_viewer, 1e-4, 1.0);
  float roughness = clamp(s.roughness, 0.0, 1.0);
  lobes.eta = leveled_ior(s.ior, s.specular_level);
  float root = (lobes.eta - 1.0) / (lobes.eta + 1.0);
  float slice = sqrt(abs(root)) * float(GGX_IOR_SLICES - 1);
  float below = min(floor(slice), float(GGX_IOR_SLICES - 2));
  vec4 table = ggx_table(roughness, cosine, below);
  lobes.cos_viewer = cosine;
  lobes.alpha = roughness * roughness;
  lobes.metal_f0 = s.base_color;
  float average = average_albedo(roughness);
  float missing = (1.0 - table.x) / max(table.x, 1e-4);
  if (s.glossy_only) {
    lobes.metal_edge = 0.0;
    lobes.metal_weight = multiple_scattering(s.base_color, average, missing);
    lobes.dielectric_weight = 0.0;
    lobes.diffuse = vec3(0.0);
    lobes.specular_albedo = table.x * s.base_color * lobes.metal_weight;
    return lobes;
  }
  float metallic = clamp(s.metallic, 0.0, 1.0);
  lobes.metal_edge = 1.0;
  lobes.metal_weight = metallic * multiple_scattering(mix(s.base_color, vec3(1.0), 1.0 / 21.0), average, missing);
  lobes.specular_albedo = table.x * lobes.metal_weight * mix(s.base_color, vec3(1.0), table.y);
  lobes.dielectric_weight = 0.0;
  lobes.diffuse = (1.0 - metallic) * s.base_color;
  if (metallic < 1.0 && lobes.eta != 1.0) {
    float fresnel = lobes.eta < 1.0 ?
      0.997118 + lobes.eta * (0.1014 - lobes.eta * (0.965241 + lobes.eta * 0.130607)) :
      (lobes.eta - 1.0) / (4.08567 + 1.00071 * lobes.eta);
    float scattering = multiple_scattering(vec3(fresnel), average, missing).x;
    float albedo = table.x * scattering * mix(root * root, 1.0, mix(table.z, table.w, slice - below));
    lobes.dielectric_weight = (1.0 - metallic) * scattering;
    lobes.specular_albedo += vec3((1.0 - metallic) * albedo);
    lobes.diffuse *= clamp(1.0 - albedo, 0.0, 1.0);
  }
  return lobes;
}

// BSDF of the glossy lobe times the cosine to the light; `alpha` may be wider than the surface's own.
vec3 glossy_lobe(Lobes lobes, float alpha, vec3 normal, vec3 to_viewer, vec3 to_light, float cos_light)
{
  vec3 half_vector = normalize(to_viewer + to_light);
  float cos_half = clamp(dot(normal, half_vector), 0.0, 1.0);
  float cos_difference = clamp(dot(to_viewer, half_vector), 0.0, 1.0);
  float alpha2 = alpha * alpha;
  float spread = cos_half * cos_half * (alpha2 - 1.0) + 1.0;
  float distribution = alpha2 / (LIGHTING_PI * spread * spread);
  float cv = lobes.cos_viewer;
  // Smith's masking and shadowing, height-correlated, over 4 cos cos
  float lambda_v = cos_light * sqrt(alpha2 + (1.0 - alpha2) * cv * cv);
  float lambda_l = cv * sqrt(alpha2 + (1.0 - alpha2) * cos_light * cos_light);
  float visibility = 0.5 / max(lambda_v + lambda_l, 1e-7);
  vec3 fresnel = lobes.metal_weight * schlick(lobes.metal_f0, lobes.metal_edge, cos_difference);
  if (lobes.dielectric_weight > 0.0) {
    fresnel += lobes.dielectric_weight * fresnel_dielectric(cos_difference, lobes.eta);
  }
  return fresnel * (distribution * visibility * cos_light);
}
