// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Fresnel terms of the Principled BSDF.

// Never below the reflectance at normal incidence, as Cycles' generalized Schlick term.
float fresnel_dielectric(float cosine, float eta)
{
  float root = (eta - 1.0) / (eta + 1.0);
  float c = abs(cosine);
  float g = eta * eta - 1.0 + c * c;
  if (g <= 0.0) {
    return 1.0;  // total reflection
  }
  g = sqrt(g);
  float a = (g - c) / (g + c);
  float b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
  return max(0.5 * a * a * (1.0 + b * b), root * root);
}

// IOR whose reflectance at normal incidence is that of `ior` times 2 * level.
float leveled_ior(float ior, float level)
{
  if (level == 0.5) {
    return ior;
  }
  float root = (ior - 1.0) / (ior + 1.0);
  float f0 = min(root * root * 2.0 * max(level, 0.0), 0.99);
  float eta = (1.0 + sqrt(f0)) / (1.0 - sqrt(f0));
  return ior < 1.0 ? 1.0 / eta : eta;
}

vec3 schlick(vec3 f0, float edge, float cosine)
{
  float s = clamp(1.0 - cosine, 0.0, 1.0);
  float s2 = s * s;
  return mix(f0, vec3(1.0), edge * s2 * s2 * s);
}

// Sharp reflectance, without microfacets.
vec3 sharp_reflectance(vec3 base_color, float metallic, float ior, float level, bool glossy_only, float cos_viewer)
{
  if (glossy_only) {
    return base_color;
  }
  vec3 dielectric = vec3(fresnel_dielectric(cos_viewer, leveled_ior(ior, level)));
  return mix(dielectric, schlick(base_color, 1.0, cos_viewer), clamp(metallic, 0.0, 1.0));
}
