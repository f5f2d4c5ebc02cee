// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface is made of at one place.
#from scene.programs.bits import KIND_GLOSSY_ONLY, KIND_THIN_WALL, KIND_GLASS, KIND_REFRACTION

struct Material {
  vec3 base_color;
  float metallic;
  float roughness;
  float ior;
  float specular_level;
  vec3 specular_tint;
  vec3 emission;
  vec3 normal;                // unit, towards the ray; the coat's too
  float transmission;
  float alpha;
  vec3 transparent_tint;
  float coat_weight;
  float coat_roughness;
  float coat_ior;
  vec3 coat_tint;
  float sheen_weight;
  float sheen_roughness;
  vec3 sheen_tint;
  float film_thickness;       // nanometers, 0: none
  float film_ior;
  float anisotropy;
  float anisotropic_rotation; // turns, from the tangent about the object's Z axis
  float diffuse_roughness;
  float subsurface;           // share of the diffuse part that goes below the surface
  float translucency;         // share of the diffuse part that comes out on the other side
  float kind;                 // KIND_ bits, which programs set
  // The same told apart, by settled() (surfaces/material_at.glsl):
  bool glossy_only;           // reflects the base color at all angles
  bool thin_wall;
  int glass;                  // scene/arrays.py, Glass: GLASS_PRINCIPLED, GLASS_GLASS, GLASS_REFRACTION
  vec3 absorption;            // per meter, inside
#ifdef LIGHTING_LINKED
  int light_set;
  int shines_on;              // bits of the light sets that its emission gets to
#endif
};
