// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The layers of a material towards one viewer, in the order of Cycles' Principled BSDF (Blender 5.2): sheen, coat,
// metal, glass, dielectric, diffuse base; as optics/scattering/layers.py.
#include "surfaces/material_at.glsl"
#include "scattering/dielectric.glsl"
#include "scattering/sheen.glsl"
#include "scattering/microfacet.glsl"
#include "scattering/film.glsl"
#ifdef PATHS_GLASS
#include "scattering/glass.glsl"
#endif

struct Layers {
  float cos_viewer;
  vec2 alpha;           // widths of the base's microfacets
  bool is_sharp;
  vec3 metal;           // share of the metal times its multiple scattering
  vec3 metal_f0;
  vec3 metal_dip;
  float metal_edge;     // 0: reflects alike at every angle (Glossy BSDF)
  vec3 dielectric;      // the same of the dielectric
  vec3 dielectric_f0;
  float eta;
  float film;           // nanometers
  float film_ior;
  vec3 specular_albedo; // of metal and dielectric
  vec3 above;           // what the coat lets through
  vec3 base;            // what metal, glass and dielectric leave to the diffuse base, below the coat
#ifdef PATHS_COAT
  float coat;           // share of the coat times its multiple scattering
  float coat_alpha;
  float coat_eta;
  float coat_albedo;
#endif
#ifdef PATHS_GLASS
  Pane glass;
#endif
};

vec3 metal_fresnel(Layers layers, float cosine)
{
  if (has_film(layers.film)) {
    return film_on_metal(layers.film, layers.film_ior, layers.metal_f0, layers.metal_dip, cosine);
  }
  return tinted_metal(layers.metal_f0, layers.metal_dip, cosine);
}

vec2 base_alpha(Material m, float roughness)
{
  vec2 alpha = vec2(roughness * roughness);
#ifdef PATHS_ANISOTROPY
  if (m.glossy_only) {
    float stretch = 1.0 - min(abs(m.anisotropy), 0.99);
    alpha *= m.anisotropy < 0.0 ? vec2(1.0 / stretch, stretch) : vec2(stretch, 1.0 / stretch);
  }
  else {
    float aspect = sqrt(1.0 - 0.9 * clamp(m.anisotropy, 0.0, 1.0));
    alpha *= vec2(1.0 / aspect, aspect);
  }
  alpha = min(alpha, 1.0);
#endif
  return alpha;
}

// Sheen and coat: what is above all else. (Sheen has no lobe here: it is as wide as the diffuse base, and is shaded.)
void add_coat(Material m, inout Layers layers)
{
  layers.above = vec3(1.0);
#ifdef PATHS_SHEEN
  float sheen = m.sheen_weight * largest(m.sheen_tint) * sheen_lobe(m.sheen_roughness, layers.cos_viewer).z;
  layers.above *= clamp(1.0 - sheen, 0.0, 1.0);
#endif
#ifdef PATHS_COAT
  float weight = max(m.coat_weight, 0.0);
  float roughness = clamp(m.coat_roughness, 0.0, 1.0);
  layers.coat_eta = max(m.coat_ior, 1.0);
  layers.coat_alpha = roughness * roughness;
  vec3 scattering;
  vec3 f0 = vec3(normal_reflectance(layers.coat_eta));
  float albedo = weight * dielectric_albedo(roughness, layers.cos_viewer, layers.coat_eta, f0, scattering).x;
  layers.coat_albedo = layers.above.x * albedo;
  layers.coat = layers.above.x * weight * scattering.x;
  layers.above *= clamp(1.0 - albedo, 0.0, 1.0);
  layers.above *= coat_tint_on_way(m.coat_tint, weight, layers.coat_eta, layers.cos_viewer);
#endif
}

Layers layers_of(Material m, bool is_back, float cos_viewer)
{
  Layers layers;
  layers.cos_viewer = clamp(cos_viewer, 1e-4, 1.0);
  float roughness = clamp(m.roughness, 0.0, 1.0);
  add_coat(m, layers);
  layers.alpha = base_alpha(m, roughness);
#ifdef PATHS_ANISOTROPY
  roughness = sqrt(sqrt(layers.alpha.x * layers.alpha.y));
#endif
  layers.is_sharp = is_sharp_alpha(sqrt(layers.alpha.x * layers.alpha.y));
  layers.alpha = max(layers.alpha, SMALLEST_ALPHA);
  vec4 table = ggx_table(roughness, layers.cos_viewer, 0.0);
  float missing = layers.is_sharp ? 0.0 : (1.0 - table.x) / max(table.x, 1e-4);
  float average = average_albedo(roughness);
  vec3 share = layers.above;
  layers.eta = 1.0;
  layers.dielectric = vec3(0.0);
  layers.dielectric_f0 = vec3(0.0);
  layers.metal_dip = vec3(0.0);
  layers.metal_f0 = max(m.base_color, 0.0);
  layers.metal_edge = m.glossy_only ? 0.0 : 1.0;
  layers.film = m.film_thickness;
  layers.film_ior = m.film_ior;
  if (m.glossy_only) {
    layers.metal = share * multiple_scattering(min(layers.metal_f0, 1.0), average, missing);
    layers.specular_albedo = table.x * layers.metal * layers.metal_f0;
    layers.base = vec3(0.0);
#ifdef PATHS_GLASS
    layers.glass = no_pane();
#endif
    return layers;
  }
  float metallic = clamp(m.metallic, 0.0, 1.0);
  layers.metal_f0 = min(layers.metal_f0, 1.0);
  layers.metal_dip = edge_dip(layers.metal_f0, clamp(m.specular_tint, 0.0, 1.0));
  vec3 mean_metal = mix(layers.metal_f0, vec3(1.0), 1.0 / 21.0) - layers.metal_dip / 126.0;
  layers.metal = share * metallic * multiple_scattering(mean_metal, average, missing);
  // (Under a film as a smooth surface, as Cycles.)
  layers.specular_albedo = table.x * layers.metal * (has_film(layers.film) ?
    metal_fresnel(layers, layers.cos_viewer) : mix(layers.metal_f0, vec3(1.0), table.y));
  share *= 1.0 - metallic;
#ifdef PATHS_GLASS
  float transmission = clamp(m.transmission, 0.0, 1.0);
  layers.glass = pane_of(m, is_back, layers.cos_viewer, share * transmission);
  share *= 1.0 - transmission;
#endif
  layers.eta = leveled_ior(max(m.ior, 1e-5), m.specular_level);
  if (metallic < 1.0 && (layers.eta != 1.0 || has_film(layers.film))) {
    vec3 scattering;
    layers.dielectric_f0 = clamp(normal_reflectance(layers.eta) * m.specular_tint, 0.0, 1.0);
    vec3 albedo = dielectric_albedo(roughness, layers.cos_viewer, layers.eta, layers.dielectric_f0, scattering);
    if (has_film(layers.film)) {
      vec3 f0 = layers.dielectric_f0;
      albedo = table.x * scattering *
               film_on_dielectric(layers.film, layers.film_ior, f0, layers.eta, layers.cos_viewer);
    }
    layers.dielectric = share * (layers.is_sharp ? vec3(1.0) : scattering);
    layers.specular_albedo += share * albedo;
    share *= clamp(1.0 - largest(albedo), 0.0, 1.0);
  }
  layers.base = share * max(m.base_color, 0.0);
  return layers;
}

// Reflectance of metal and dielectric at a microfacet.
vec3 specular_fresnel(Layers layers, float cosine)
{
  vec3 sum = layers.metal * (layers.metal_edge > 0.5 ? metal_fresnel(layers, cosine) : layers.metal_f0);
  if (largest(layers.dielectric) > 0.0) {
    sum += layers.dielectric *
           film_or_dielectric(layers.film, layers.film_ior, layers.dielectric_f0, layers.eta, cosine);
  }
  return sum;
}
