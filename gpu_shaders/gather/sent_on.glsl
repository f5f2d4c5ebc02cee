// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Share of what arrives at a surface that it sends on towards a viewer, whatever way it came. `side`: its normal
// towards the viewer, which is turned where by chance (`random`) that on the other side is asked for, which comes
// through.

vec3 sent_on(Material m, float random, vec3 direction, inout vec3 side)
{
  Surface s;
  s.position = vec3(0.0);
  s.normal = side;
  s.base_color = m.base_color;
  s.metallic = m.metallic;
  s.roughness = m.roughness;
  s.ior = m.ior;
  s.specular_level = m.specular_level;
  s.emission = vec3(0.0);
  s.glossy_only = m.glossy_only;
  add_layers(s, m);
  Lobes lobes = lobes_of(s, abs(dot(side, direction)));
  vec3 sum = lobes.diffuse + lobes.specular_albedo;
#ifdef SURFACE_SHEEN
  sum += lobes.sheen;
#endif
#ifdef SURFACE_COAT
  sum += vec3(lobes.coat_albedo);
#endif
#ifdef SURFACE_TRANSLUCENT
  float through = mean_of(lobes.translucent);
  float chance = through / max(through + mean_of(sum), 1e-9);
  if (random < chance) {
    side = -side;
    return clamp(lobes.translucent, vec3(0.0), vec3(1.0)) / chance;
  }
  sum /= 1.0 - chance;
#endif
  return max(sum, vec3(0.0));
}
