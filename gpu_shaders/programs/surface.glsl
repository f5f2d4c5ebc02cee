// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as it is lit. What only some materials have is there in scenes with such alone
// (renderer/paths/surface_features.py).
#include "programs/material.glsl"

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
#ifdef LIGHTING_LINKED
  int light_set;
  int shines_on;      // bits of the light sets that its emission gets to
#endif
};

Surface surface_made_of(Material m, vec3 position, vec3 normal)
{
  Surface s;
  s.position = position;
  s.normal = normal;
  s.base_color = m.base_color;
  s.metallic = m.metallic;
  s.roughness = m.roughness;
  s.ior = m.ior;
  s.specular_level = m.specular_level;
  s.emission = m.emission;
  s.glossy_only = m.glossy_only;
#ifdef SURFACE_TINT
  s.specular_tint = m.specular_tint;
#endif
#ifdef SURFACE_SHEEN
  s.sheen = m.sheen_weight * m.sheen_tint;
  s.sheen_roughness = m.sheen_roughness;
#endif
#ifdef SURFACE_COAT
  s.coat_weight = m.coat_weight;
  s.coat_roughness = m.coat_roughness;
  s.coat_ior = m.coat_ior;
  s.coat_tint = m.coat_tint;
#endif
#ifdef SURFACE_DIFFUSE_ROUGHNESS
  s.diffuse_roughness = m.diffuse_roughness;
  s.subsurface = m.subsurface;
#endif
#ifdef SURFACE_TRANSLUCENT
  s.translucency = m.translucency;
#endif
#ifdef LIGHTING_LINKED
  s.light_set = m.light_set;
  s.shines_on = m.shines_on;
#endif
  return s;
}
