// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface does to a path that meets it, out of the sampler `materials` (renderer/surfaces/materials.py).
#include "surfaces/material_records.glsl"

struct PathMaterial {
  vec3 base_color;
  float metallic;
  float roughness;
  float ior;
  float specular_level;
  vec3 specular_tint;
  bool glossy_only;
  vec3 emission;
  float transmission;
  int glass;               // scene/arrays.py, Glass: GLASS_PRINCIPLED, GLASS_GLASS, GLASS_REFRACTION
  bool thin_wall;
  float alpha;             // after its threshold
  vec3 transparent_tint;
  float coat_weight;
  float coat_roughness;
  float coat_ior;
  vec3 coat_tint;
  float film_thickness;    // nanometers, 0: none
  float film_ior;
  float anisotropy;
  float anisotropic_rotation;
  bool tangent_by_uv;
  vec3 absorption;         // per meter, inside
#ifdef PATHS_SHEEN
  vec3 sheen;              // weight times tint
  float sheen_roughness;
#endif
};

// `scalars`: roughness, metallic, transmission and alpha of this place where the material has an image of them.
PathMaterial path_material(int index, vec3 base_color, vec4 scalars)
{
  int record = MATERIAL_RECORDS * max(index, 0);
  vec4 a = fetch_record(materials, record);
  vec4 b = fetch_record(materials, record + 1);
  vec4 coat = fetch_record(materials, record + 5);
  vec4 coat_tint = fetch_record(materials, record + 6);
  vec4 specular = fetch_record(materials, record + 7);
  vec4 inside = fetch_record(materials, record + 8);
  vec4 transparent = fetch_record(materials, record + 9);
  vec4 rest = fetch_record(materials, record + 10);
  int flags = int(rest.w + 0.5);
  PathMaterial m;
  m.base_color = base_color;
  m.metallic = a.x;
  m.roughness = a.y;
  m.ior = a.z;
  m.specular_level = a.w;
  m.specular_tint = specular.rgb;
  m.glossy_only = b.w > 0.5;
  m.emission = b.rgb;
  m.transmission = coat.w;
  m.glass = int(coat_tint.w + 0.5);
  m.thin_wall = (flags & 1) != 0;
  m.alpha = transparent.w;
  m.transparent_tint = transparent.rgb;
  m.coat_weight = coat.x;
  m.coat_roughness = coat.y;
  m.coat_ior = coat.z;
  m.coat_tint = coat_tint.rgb;
  m.film_thickness = specular.w;
  m.film_ior = inside.w;
  m.anisotropy = rest.y;
  m.anisotropic_rotation = rest.z;
  m.tangent_by_uv = (flags & 2) != 0;
  m.absorption = inside.rgb;
#ifdef PATHS_SHEEN
  vec4 sheen = fetch_record(materials, record + 13);
  m.sheen = sheen.rgb;
  m.sheen_roughness = sheen.w;
#endif
#ifdef PATHS_SCALARS
  if (fetch_record(materials, record + 12).x > -0.5) {
    m.roughness = scalars.x;
    m.metallic = scalars.y;
    m.transmission = scalars.z;
    m.alpha = scalars.w;
  }
#endif
  if (rest.x >= 0.0) {
    m.alpha = (m.alpha > rest.x) != ((flags & 4) != 0) ? 1.0 : 0.0;
  }
  return m;
}
