// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The Principled BSDF of Blender 5.2 as far as Curvrefl shades it by lamps and world: one GGX lobe over a Lambertian
// base and, where a scene has them (renderer/paths/surface_features.py), sheen and a coat above, tints, and bases
// that are rough or let light through to the other side. As optics/scattering/shaded.py.

#include "programs/surface.glsl"
#include "lighting/fresnel.glsl"
#include "scattering/dielectric.glsl"
#include "scattering/oren_nayar.glsl"
#include "scattering/sheen.glsl"

// The surface's lobes towards one viewer.
struct Lobes {
  vec3 diffuse;         // albedo of the Lambertian base, what the lobe above reflects taken off
  vec3 metal_f0;        // Fresnel at normal incidence of the metal, or of a glossy BSDF at every angle
  float metal_edge;     // 1: Schlick towards white at the edge, 0: none
  vec3 metal_weight;    // share of the metal times its multiple scattering
  vec3 dielectric_weight;
  float eta;            // IOR that gives the dielectric its reflectance after "IOR Level"
  float alpha;          // GGX width
  float cos_viewer;
  vec3 specular_albedo; // of the whole lobe: metal and dielectric
#ifdef SURFACE_TINT
  vec3 metal_dip;       // what tints the metal at the edge
  vec3 dielectric_f0;
#endif
#if defined(SURFACE_SHEEN) || defined(SURFACE_COAT)
  vec3 above;           // what sheen and coat let through of what is below them
#endif
#ifdef SURFACE_SHEEN
  vec3 sheen;           // albedo
  vec2 sheen_transform;
#endif
#ifdef SURFACE_COAT
  float coat_weight;    // share times multiple scattering, below the sheen
  float coat_alpha;
  float coat_eta;
  float coat_albedo;
#endif
#ifdef SURFACE_DIFFUSE_ROUGHNESS
  OrenNayar rough_base;
#endif
#ifdef SURFACE_TRANSLUCENT
  vec3 translucent;     // albedo towards the other side
#endif
};

// No lobe reflects, whose base has this albedo.
Lobes base_lobes(Surface s, vec3 albedo, float cos_viewer)
{
  Lobes lobes;
  lobes.diffuse = albedo;
  lobes.metal_f0 = lobes.metal_weight = lobes.dielectric_weight = lobes.specular_albedo = vec3(0.0);
  lobes.metal_edge = 0.0;
  lobes.eta = 1.5;
  lobes.alpha = 1.0;
  lobes.cos_viewer = clamp(cos_viewer, 1e-4, 1.0);
#ifdef SURFACE_TINT
  lobes.metal_dip = lobes.dielectric_f0 = vec3(0.0);
#endif
#if defined(SURFACE_SHEEN) || defined(SURFACE_COAT)
  lobes.above = vec3(1.0);
#endif
#ifdef SURFACE_SHEEN
  lobes.sheen = vec3(0.0);
  lobes.sheen_transform = vec2(1.0, 0.0);
#endif
#ifdef SURFACE_COAT
  lobes.coat_weight = lobes.coat_albedo = 0.0;
  lobes.coat_alpha = 1.0;
  lobes.coat_eta = 1.5;
#endif
#ifdef SURFACE_DIFFUSE_ROUGHNESS
  lobes.rough_base = oren_nayar_of(s.base_color, s.diffuse_roughness, s.subsurface, lobes.cos_viewer);
#endif
#ifdef SURFACE_TRANSLUCENT
  float through = clamp(s.translucency, 0.0, 1.0);
  lobes.translucent = through * albedo;
  lobes.diffuse = albedo - lobes.translucent;
#endif
  return lobes;
}

#ifdef SURFACE_SHEEN
void add_sheen(Surface s, inout Lobes lobes)
{
  vec3 lobe = sheen_lobe(s.sheen_roughness, lobes.cos_viewer);
  lobes.sheen = max(s.sheen, 0.0) * lobe.z;
  lobes.sheen_transform = lobe.xy;
  lobes.above *= clamp(1.0 - largest(lobes.sheen), 0.0, 1.0);
}
#endif

#ifdef SURFACE_COAT
void add_coat_lobe(Surface s, inout Lobes lobes)
{
  float weight = max(s.coat_weight, 0.0);
  float roughness = clamp(s.coat_roughness, 0.0, 1.0);
  vec3 scattering;
  lobes.coat_eta = max(s.coat_ior, 1.0);
  lobes.coat_alpha = roughness * roughness;
  vec3 f0 = vec3(normal_reflectance(lobes.coat_eta));
  float albedo = weight * dielectric_albedo(roughness, lobes.cos_viewer, lobes.coat_eta, f0, scattering).x;
  lobes.coat_albedo = lobes.above.x * albedo;
  lobes.coat_weight = lobes.above.x * weight * scattering.x;
  lobes.above *= clamp(1.0 - albedo, 0.0, 1.0);
  lobes.above *= coat_tint_on_way(s.coat_tint, weight, lobes.coat_eta, lobes.cos_viewer);
}
#endif

Lobes lobes_of(Surface s, float cos_viewer)
{
  float cosine = clamp(cos_viewer, 1e-4, 1.0);
  float roughness = clamp(s.roughness, 0.0, 1.0);
  float metallic = s.glossy_only ? 1.0 : clamp(s.metallic, 0.0, 1.0);
  float eta = leveled_ior(s.ior, s.specular_level);
  float root = (eta - 1.0) / (eta + 1.0);
  float slice = sqrt(abs(root)) * float(GGX_IOR_SLICES - 1);
  float below = min(floor(slice), float(GGX_IOR_SLICES - 2));
  vec4 table = ggx_table(roughness, cosine, below);
  float average = average_albedo(roughness);
  float missing = (1.0 - table.x) / max(table.x, 1e-4);
  vec3 dielectric_share = vec3(0.0), albedo = vec3(0.0);
  if (metallic < 1.0 && eta != 1.0) {
#ifdef SURFACE_TINT
    vec3 f0 = clamp(root * root * s.specular_tint, 0.0, 1.0);
    albedo = dielectric_albedo(roughness, cosine, eta, f0, dielectric_share);
#else
    dielectric_share = multiple_scattering(vec3(mean_dielectric(eta)), average, missing);
    albedo = vec3(table.x * dielectric_share.x * mix(root * root, 1.0, mix(table.z, table.w, slice - below)));
#endif
  }
  vec3 base = (1.0 - metallic) * clamp(1.0 - largest(albedo), 0.0, 1.0) * s.base_color;
  Lobes lobes = base_lobes(s, base, cosine);
  lobes.eta = eta;
  lobes.alpha = roughness * roughness;
  lobes.metal_f0 = s.base_color;
  lobes.metal_edge = s.glossy_only ? 0.0 : 1.0;
  vec3 mean_metal = mix(s.base_color, vec3(1.0), lobes.metal_edge / 21.0);
#ifdef SURFACE_TINT
  lobes.dielectric_f0 = clamp(root * root * s.specular_tint, 0.0, 1.0);
  if (!s.glossy_only) {
    lobes.metal_f0 = min(s.base_color, 1.0);
    lobes.metal_dip = edge_dip(lobes.metal_f0, clamp(s.specular_tint, 0.0, 1.0));
    mean_metal = mix(lobes.metal_f0, vec3(1.0), 1.0 / 21.0) - lobes.metal_dip / 126.0;
  }
#endif
  lobes.metal_weight = metallic * multiple_scattering(mean_metal, average, missing);
  lobes.specular_albedo = table.x * lobes.metal_weight * mix(lobes.metal_f0, vec3(1.0), lobes.metal_edge * table.y);
#ifdef SURFACE_TINT
  float dip = ggx_table(roughness, cosine, float(GGX_IOR_SLICES - 1)).w;
  lobes.specular_albedo -= table.x * lobes.metal_weight * lobes.metal_dip * dip;
#endif
  lobes.dielectric_weight = (1.0 - metallic) * dielectric_share;
  lobes.specular_albedo += (1.0 - metallic) * albedo;
#ifdef SURFACE_SHEEN
  add_sheen(s, lobes);
#endif
#ifdef SURFACE_COAT
  add_coat_lobe(s, lobes);
#endif
#if defined(SURFACE_SHEEN) || defined(SURFACE_COAT)
  lobes.diffuse *= lobes.above;
  lobes.metal_weight *= lobes.above;
  lobes.dielectric_weight *= lobes.above;
  lobes.specular_albedo *= lobes.above;
#ifdef SURFACE_TRANSLUCENT
  lobes.translucent *= lobes.above;
#endif
#endif
  return lobes;
}

// GGX distribution and Smith's masking and shadowing, height-correlated, over 4 times the viewer's cosine.
float ggx_reflected(float alpha, float cos_half, float cos_viewer, float cos_light)
{
  float alpha2 = alpha * alpha;
  float spread = cos_half * cos_half * (alpha2 - 1.0) + 1.0;
  float distribution = alpha2 / (LIGHTING_PI * spread * spread);
  float lambda_v = cos_light * sqrt(alpha2 + (1.0 - alpha2) * cos_viewer * cos_viewer);
  float lambda_l = cos_viewer * sqrt(alpha2 + (1.0 - alpha2) * cos_light * cos_light);
  return distribution * (0.5 / max(lambda_v + lambda_l, 1e-7)) * cos_light;
}

// BSDF of the glossy lobe times the cosine to the light; `alpha` may be wider than the surface's own.
vec3 glossy_lobe(Lobes lobes, float alpha, vec3 normal, vec3 to_viewer, vec3 to_light, float cos_light)
{
  vec3 half_vector = normalize(to_viewer + to_light);
  float cos_half = clamp(dot(normal, half_vector), 0.0, 1.0);
  float cos_difference = clamp(dot(to_viewer, half_vector), 0.0, 1.0);
#ifdef SURFACE_TINT
  vec3 fresnel = lobes.metal_weight * (lobes.metal_edge > 0.5 ?
    tinted_metal(lobes.metal_f0, lobes.metal_dip, cos_difference) : lobes.metal_f0);
  if (lobes.dielectric_weight.g > 0.0) {
    fresnel += lobes.dielectric_weight * tinted_dielectric(lobes.dielectric_f0, lobes.eta, cos_difference);
  }
#else
  vec3 fresnel = lobes.metal_weight * schlick(lobes.metal_f0, lobes.metal_edge, cos_difference);
  if (lobes.dielectric_weight.g > 0.0) {
    fresnel += lobes.dielectric_weight * fresnel_dielectric(cos_difference, lobes.eta);
  }
#endif
  return fresnel * ggx_reflected(alpha, cos_half, lobes.cos_viewer, cos_light);
}

#ifdef SURFACE_COAT
// The same of the coat.
float coat_lobe(Lobes lobes, float alpha, vec3 normal, vec3 to_viewer, vec3 to_light, float cos_light)
{
  vec3 half_vector = normalize(to_viewer + to_light);
  float cos_half = clamp(dot(normal, half_vector), 0.0, 1.0);
  float cos_difference = clamp(dot(to_viewer, half_vector), 0.0, 1.0);
  float fresnel = fresnel_dielectric(cos_difference, lobes.coat_eta);
  return lobes.coat_weight * fresnel * ggx_reflected(alpha, cos_half, lobes.cos_viewer, cos_light);
}
#endif

// Unit, along the surface towards the viewer; none where that is straight above.
vec3 along_to_viewer(vec3 normal, vec3 to_viewer)
{
  vec3 across = to_viewer - normal * dot(normal, to_viewer);
  return across * inversesqrt(max(dot(across, across), 1e-12));
}

// BSDF of base and sheen times the cosine to a light on the viewer's side.
vec3 diffuse_lobes(Surface s, Lobes lobes, vec3 to_viewer, vec3 to_light, float cos_light)
{
  float l = max(cos_light, 0.0);
#ifdef SURFACE_DIFFUSE_ROUGHNESS
  float cos_between = dot(to_viewer, to_light);
  vec3 sum = lobes.diffuse *
             oren_nayar_value(lobes.rough_base, s.diffuse_roughness, lobes.cos_viewer, l, cos_between);
#else
  vec3 sum = lobes.diffuse * (l / LIGHTING_PI);
#endif
#ifdef SURFACE_SHEEN
  if (largest(lobes.sheen) > 0.0) {
    vec3 x = along_to_viewer(s.normal, to_viewer);
    vec3 light = vec3(dot(x, to_light), dot(cross(s.normal, x), to_light), l);
    sum += lobes.sheen * sheen_value(lobes.sheen_transform, light);
  }
#endif
  return sum;
}
