// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The GGX microfacet surface with Smith's height-correlated masking, as optics/scattering/microfacet.py. Vectors in
// the surface's frame: z is the normal, x the tangent. `alpha`: widths along x and y.

#include "common/ggx_table.glsl"
#include "scattering/frame.glsl"

// The smallest width that single precision bears.
#define SMALLEST_ALPHA 1e-4

// Whether a lobe is so narrow that it is followed as a single direction.
bool is_sharp_alpha(float alpha)
{
#ifdef PATHS_ROUGH
  return alpha <= GGX_SINGULAR_ALPHA;
#else
  return true;
#endif
}

// The viewer's direction in the surface's frame, a little above it.
vec3 viewer_in(mat3 frame, vec3 to_viewer)
{
  vec3 local = to_viewer * frame;
  local.z = max(local.z, 1e-4);
  return normalize(local);
}

// Density of microfacet normals, Walter et al. (2007), eq. 33, stretched.
float ggx_density(vec3 h, vec2 alpha)
{
  vec3 stretched = vec3(h.xy / alpha, h.z);
  float square = dot(stretched, stretched);
  return 1.0 / (PI * alpha.x * alpha.y * square * square);
}

// Length of the direction stretched by the widths: Smith's lambda is (that / abs(w.z) - 1) / 2, Heitz (2014), eq. 72.
float stretched_length(vec3 w, vec2 alpha)
{
  vec2 flattened = alpha * w.xy;
  return sqrt(dot(flattened, flattened) + w.z * w.z);
}

// Masking of the viewer and the light together, over masking of the viewer.
float shadowing(vec3 to_viewer, vec3 to_light, vec2 alpha)
{
  float viewer = stretched_length(to_viewer, alpha) / to_viewer.z;
  float light = stretched_length(to_light, alpha) / max(abs(to_light.z), 1e-7);
  return (1.0 + viewer) / (viewer + light);
}

// How far down the spherical cap of sampled directions reaches where only those above the surface are wanted, 1 for
// all: Tokuyoshi and Eto, "Bounded VNDF Sampling for the Smith-GGX BRDF" (2024).
float cap_bound(vec3 to_viewer, vec2 alpha)
{
  float a2 = min(alpha.x, alpha.y);
  a2 = min(a2 * a2, 1.0);
  float s = 1.0 + length(to_viewer.xy);
  float s2 = s * s;
  return (1.0 - a2) * s2 / (s2 + a2 * to_viewer.z * to_viewer.z);
}

// A microfacet normal out of those that the viewer sees, by a spherical cap: Dupuy and Benyoub, "Sampling Visible GGX
// Normals with Spherical Caps" (2023). `bound`: of cap_bound, or 1.
vec3 visible_normal(vec3 to_viewer, vec2 alpha, float bound, vec2 random)
{
  vec3 stretched = normalize(vec3(alpha * to_viewer.xy, to_viewer.z));
  float phi = 2.0 * PI * random.x;
  float b = bound * stretched.z;
  float z = (1.0 - random.y) * (1.0 + b) - b;
  float sine = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
  vec3 h = vec3(sine * cos(phi), sine * sin(phi), z) + stretched;
  h = vec3(alpha * h.xy, max(h.z, 0.0));
  float square = dot(h, h);
  return square > 1e-20 ? h * inversesqrt(square) : vec3(0.0, 0.0, 1.0);
}

// Density of directions that visible_normal's normals reflect the viewer's to.
float reflected_density(vec3 to_viewer, vec3 h, vec2 alpha, float bound)
{
  return ggx_density(h, alpha) / (2.0 * (bound * to_viewer.z + stretched_length(to_viewer, alpha)));
}

// BRDF of reflection without Fresnel's term, times the cosine to the light.
float reflected_value(vec3 to_viewer, vec3 to_light, vec3 h, vec2 alpha)
{
  return reflected_density(to_viewer, h, alpha, 1.0) * shadowing(to_viewer, to_light, alpha);
}
