// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Share of what arrives at a surface that it sends on towards a viewer, whatever way it came.

vec3 sent_on(Material m, vec3 normal, vec3 direction)
{
  Surface s;
  s.position = vec3(0.0);
  s.normal = normal;
  s.base_color = m.base_color;
  s.metallic = m.metallic;
  s.roughness = m.roughness;
  s.ior = m.ior;
  s.specular_level = m.specular_level;
  s.emission = vec3(0.0);
  s.glossy_only = m.glossy_only;
  add_layers(s, m);
  Lobes lobes = lobes_of(s, abs(dot(normal, direction)));
  vec3 sum = lobes.diffuse + lobes.specular_albedo;
#ifdef SURFACE_TRANSLUCENT
  sum += lobes.translucent;
#endif
#ifdef SURFACE_SHEEN
  sum += lobes.sheen;
#endif
#ifdef SURFACE_COAT
  sum += vec3(lobes.coat_albedo);
#endif
  return clamp(sum, vec3(0.0), vec3(1.0));
}
