// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Fresnel terms of layers with their tints, as optics/scattering/fresnel.py.
#include "lighting/fresnel.glsl"

float normal_reflectance(float eta)
{
  float root = (eta - 1.0) / (eta + 1.0);
  return root * root;
}

float largest(vec3 v)
{
  return max(v.r, max(v.g, v.b));
}

float mean_of(vec3 v)
{
  return (v.r + v.g + v.b) / 3.0;
}

// A dielectric whose reflectance at normal incidence is tinted: from `f0` to white as far as the true term gets from
// its own to 1.
vec3 tinted_dielectric(vec3 f0, float eta, float cosine)
{
  float real = normal_reflectance(eta);
  float share = clamp((fresnel_dielectric(cosine, eta) - real) / max(1.0 - real, 1e-6), 0.0, 1.0);
  return mix(f0, vec3(1.0), share);
}

// Metal: Schlick's term less what tints it at the edge; Kutz et al., "Novel aspects of the Adobe Standard Material"
// (2021). `dip` is of edge_dip.
vec3 tinted_metal(vec3 f0, vec3 dip, float cosine)
{
  float s = clamp(1.0 - cosine, 0.0, 1.0);
  float s2 = s * s;
  return clamp(schlick(f0, 1.0, cosine) - dip * (cosine * s2 * s2 * s2), 0.0, 1.0);
}

// At a cosine of 1/7, where cos (1 - cos)^6 is largest, the term is `tint` times Schlick's.
vec3 edge_dip(vec3 f0, vec3 tint)
{
  const float s = 6.0 / 7.0;
  const float s5 = s * s * s * s * s;
  return mix(f0, vec3(1.0), s5) * (1.0 - tint) * (7.0 / (s5 * s));
}

// Mean of a dielectric's term over the hemisphere, fitted: Kulla and Conty (2017).
float mean_dielectric(float eta)
{
  float fit = eta < 1.0 ? 0.997118 + eta * (0.1014 - eta * (0.965241 + eta * 0.130607)) :
                          (eta - 1.0) / (4.08567 + 1.00071 * eta);
  return clamp(fit, 0.0, 1.0);
}

// Cosine of the refracted ray to the other side of the normal; 0: nothing is refracted.
float refracted_cosine(float cosine, float eta)
{
  return sqrt(max(1.0 - max(1.0 - cosine * cosine, 0.0) / (eta * eta), 0.0));
}
