// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as it is lit. What only some materials have is there in scenes with such alone
// (renderer/paths/surface_features.py).

struct Surface {
  vec3 position;   // world space
  vec3 normal;     // unit shading normal
  vec3 base_color;
  float metallic;
  float roughness;
  float ior;
  float specular_level;
  vec3 emission;
  bool glossy_only;
#ifdef SURFACE_TINT
  vec3 specular_tint;
#endif
#ifdef SURFACE_SHEEN
  vec3 sheen;      // weight times tint
  float sheen_roughness;
#endif
#ifdef SURFACE_COAT
  float coat_weight;
  float coat_roughness;
  float coat_ior;
  vec3 coat_tint;
#endif
#ifdef SURFACE_DIFFUSE_ROUGHNESS
  float diffuse_roughness;
  float subsurface;   // share of the base that is drawn as even
#endif
#ifdef SURFACE_TRANSLUCENT
  float translucency; // share of the base that shines on the other side
#endif
};
