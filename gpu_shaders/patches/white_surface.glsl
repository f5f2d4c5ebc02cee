// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A surface that sends on all that arrives, to all sides.

Surface white_surface(vec3 position, vec3 normal)
{
  Surface s;
  s.position = position;
  s.normal = normal;
  s.base_color = vec3(1.0);
  s.metallic = 0.0;
  s.roughness = 1.0;
  s.ior = 1.5;
  s.specular_level = 0.0;
  s.emission = vec3(0.0);
  s.glossy_only = false;
#ifdef SURFACE_TINT
  s.specular_tint = vec3(1.0);
#endif
#ifdef SURFACE_SHEEN
  s.sheen = vec3(0.0);
  s.sheen_roughness = 0.5;
#endif
#ifdef SURFACE_COAT
  s.coat_weight = s.coat_roughness = 0.0;
  s.coat_ior = 1.5;
  s.coat_tint = vec3(1.0);
#endif
#ifdef SURFACE_DIFFUSE_ROUGHNESS
  s.diffuse_roughness = s.subsurface = 0.0;
#endif
#ifdef SURFACE_TRANSLUCENT
  s.translucency = 0.0;
#endif
#ifdef LIGHTING_LINKED
  s.light_set = s.shines_on = 0;
#endif
  return s;
}
