// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// An interface that lets light through, solid or thin, as optics/scattering/glass.py. Rough refraction: Walter et al.,
// "Microfacet Models for Refraction through Rough Surfaces" (2007). A thin wall: both interfaces of a pane at once,
// with what goes back and forth between them, as OpenPBR's.
#include "scattering/fresnel_layers.glsl"
#include "scattering/microfacet.glsl"
#include "common/ggx_table.glsl"
#include "scattering/film.glsl"

// A refractive index this close to 1 bends nothing that single precision could tell.
#define STRAIGHT_THROUGH 1e-4

struct Pane {
  float eta;          // of the far side over the near one; of a thin wall that of its inside
  float alpha;
  float far_alpha;    // width of the lobe on the far side: of a thin wall another
  bool is_thin;
  bool is_refraction; // a Refraction BSDF: reflects nothing
  bool is_sharp;
  bool is_far_sharp;
  float film;         // nanometers
  float film_ior;     // over that of the near side
  vec3 f0;
  vec3 reflected;     // share times tint times multiple scattering; of a thin wall times its reflectance
  vec3 transmitted;
};

Pane no_pane()
{
  return Pane(1.0, 0.0, 0.0, false, false, true, true, 0.0, 1.0, vec3(0.0), vec3(0.0), vec3(0.0));
}

// x: albedo of a rough interface without tint, single scattering; y: its mean over the hemisphere.
vec2 glass_albedo(float roughness, float cosine, float eta)
{
  float place = sqrt(abs((eta - 1.0) / (eta + 1.0)));
  float slice = place * float(GGX_IOR_SLICES - 1);
  float below = min(floor(slice), float(GGX_IOR_SLICES - 2));
  vec4 here = ggx_glass_table(roughness, cosine, below);
  vec4 next = ggx_glass_table(roughness, cosine, below + 1.0);
  vec4 average = ggx_glass_table(roughness, place, float(GGX_IOR_SLICES));
  vec3 steps = eta < 1.0 ? vec3(here.zw, next.z) : vec3(here.xy, next.x);
  // (A parabola through three steps.)
  float t = slice - below;
  float albedo = dot(steps, vec3((2.0 * t - 1.0) * (t - 1.0), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)));
  return vec2(min(albedo, 1.0), eta < 1.0 ? average.z : average.x);
}

// Reflectance and transmittance of both interfaces of a thin wall, whose inside is tinted.
void thin_shares(Pane pane, vec3 tint, float cosine, out vec3 reflectance, out vec3 transmittance)
{
  vec3 reflects = film_or_dielectric(pane.film, pane.film_ior, pane.f0, pane.eta, cosine);
  float inside = refracted_cosine(cosine, pane.eta);
  vec3 reflects_inside = reflects;
  if (has_film(pane.film)) {
    reflects_inside = film_on_dielectric(pane.film, pane.film_ior / pane.eta, pane.f0, 1.0 / pane.eta, inside);
  }
  vec3 way = inside > 0.0 ? pow(max(tint, 1e-10), vec3(1.0 / inside)) : vec3(0.0);
  vec3 again = reflects_inside * way;
  transmittance = way * (1.0 - reflects) * (1.0 - reflects_inside) / max(1.0 - again * again, 1e-6);
  reflectance = reflects + transmittance * again;
}

Pane pane_of(Material m, bool is_back, float cosine, vec3 share)
{
  Pane pane;
  float ior = max(m.ior, 1e-5);
  float roughness = clamp(m.roughness, 0.0, 1.0);
  pane.is_thin = m.thin_wall;
  pane.is_refraction = m.glass == GLASS_REFRACTION;
  pane.eta = is_back && !m.thin_wall ? 1.0 / ior : ior;
  pane.alpha = max(roughness * roughness, SMALLEST_ALPHA);
  pane.far_alpha = pane.alpha;
  pane.is_sharp = is_sharp_alpha(roughness * roughness);
  pane.is_far_sharp = pane.is_sharp || abs(pane.eta - 1.0) < STRAIGHT_THROUGH;
  pane.f0 = vec3(normal_reflectance(pane.eta));
  pane.film = pane.is_refraction ? 0.0 : m.film_thickness;
  pane.film_ior = is_back && !m.thin_wall ? m.film_ior / ior : m.film_ior;
  if (pane.is_refraction) {
    pane.reflected = vec3(0.0);
    pane.transmitted = share * m.base_color;
    return pane;
  }
  vec3 through = m.base_color;
  vec3 off = m.base_color;
  if (m.glass == GLASS_PRINCIPLED) {
    through = clamp(m.base_color, 0.0, 1.0);
    through = m.thin_wall ? through : sqrt(through);
    off = vec3(1.0);
    pane.f0 = clamp(pane.f0 * m.specular_tint, 0.0, 1.0);
  }
  if (m.thin_wall) {
    thin_shares(pane, through, cosine, pane.reflected, pane.transmitted);
    // As wide as two refractions, Kulla and Conty (2017).
    float eta = pane.eta;
    float wider = 3.4 * max(eta - 1.0, 0.0) * (eta - 0.5) * (eta - 0.5) / (eta * eta * eta);
    float far_roughness = clamp(sqrt(min(roughness * roughness * sqrt(wider), 1.0)), 0.0, 1.0);
    pane.is_far_sharp = is_sharp_alpha(far_roughness * far_roughness);
    pane.far_alpha = max(far_roughness * far_roughness, SMALLEST_ALPHA);
    float near = ggx_table(roughness, cosine, 0.0).x;
    float far = ggx_table(far_roughness, cosine, 0.0).x;
    vec3 tint = clamp(m.specular_tint, 0.0, 1.0);
    float missing = (1.0 - near) / max(near, 1e-4);
    pane.reflected *= share * (pane.is_sharp ? vec3(1.0) :
                                               multiple_scattering(tint, average_albedo(roughness), missing));
    pane.transmitted *= share * (pane.is_far_sharp ? 1.0 : 1.0 / max(far, 1e-4));
    return pane;
  }
  vec3 scattering = vec3(1.0);
  if (!pane.is_sharp) {
    vec2 albedo = glass_albedo(roughness, cosine, pane.eta);
    scattering = multiple_scattering(clamp(through, 0.0, 1.0), albedo.y, (1.0 - albedo.x) / max(albedo.x, 1e-4));
  }
  pane.reflected = share * off * scattering;
  pane.transmitted = share * through * (pane.is_far_sharp ? vec3(1.0) : scattering);
  return pane;
}

// What a microfacet of the pane reflects and transmits; of a thin wall every one alike.
void pane_shares(Pane pane, float cosine, out vec3 reflects, out vec3 transmits)
{
  reflects = pane.reflected;
  transmits = pane.transmitted;
  if (pane.is_thin) {
    return;
  }
  if (pane.is_refraction) {
    reflects = vec3(0.0);
    transmits *= refracted_cosine(cosine, pane.eta) > 0.0 ? 1.0 : 0.0;
    return;
  }
  vec3 fresnel = film_or_dielectric(pane.film, pane.film_ior, pane.f0, pane.eta, cosine);
  reflects *= fresnel;
  transmits *= 1.0 - fresnel;
}

// Share of samples that a microfacet reflects.
float reflected_chance(vec3 reflects, vec3 transmits)
{
  float reflected = mean_of(reflects);
  float sum = reflected + mean_of(transmits);
  return sum > 0.0 ? reflected / sum : 0.0;
}

// Where a microfacet with normal `h` refracts what the viewer sees.
vec3 refracted(vec3 to_viewer, vec3 h, float eta)
{
  float cosine = dot(to_viewer, h);
  return normalize((cosine / eta - refracted_cosine(cosine, eta)) * h - to_viewer / eta);
}

// Density of directions to the far side, by normals that the viewer sees, per chance that a normal refracts.
float refracted_density(vec3 to_viewer, vec3 to_light, vec3 h, float alpha, float eta)
{
  float cos_viewer = dot(to_viewer, h);
  float cos_light = dot(to_light, h);
  float root = cos_viewer + eta * cos_light;
  float solid_angle = eta * eta * abs(cos_viewer * cos_light) / max(root * root, 1e-20);
  return 4.0 * reflected_density(to_viewer, h, vec2(alpha), 1.0) * solid_angle;
}
