// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What lobes of at most this roughness send on of lamps is in few places: caustics.
#from renderer.paths.features import SHARP_ROUGHNESS

// Share of what arrives at a surface that it sends on towards a viewer, whatever way it came. `side`: its normal
// towards the viewer, which is turned where by chance (`random`) that on the other side is asked for, which comes
// through.
vec3 sent_on(Material m, float random, vec3 direction, inout vec3 side, out vec3 of_lamps)
{
  Lobes lobes = lobes_of(surface_made_of(m, vec3(0.0), side), abs(dot(side, direction)));
  // (Where caustics of lamps are followed sharp lobes send nothing from patch to patch, which have one sum of light.)
  bool is_rough = m.roughness > SHARP_ROUGHNESS;
  vec3 above = has_caustics > (is_rough ? 0.25 : 0.75) ? lobes.specular_albedo : vec3(0.0);
  vec3 sum = lobes.diffuse + above;
  of_lamps = lobes.diffuse + (is_rough ? above : vec3(0.0));
#ifdef SURFACE_SHEEN
  sum += lobes.sheen;
#endif
#ifdef SURFACE_COAT
  sum += floor(has_caustics) * lobes.coat_albedo;
#endif
#ifdef SURFACE_TRANSLUCENT
  float through = mean_of(lobes.translucent);
  float chance = through / max(through + mean_of(sum), 1e-9);
  if (random < chance) {
    side = -side;
    of_lamps = clamp(lobes.translucent, vec3(0.0), vec3(1.0)) / chance;
    return of_lamps;
  }
  sum /= 1.0 - chance;
  of_lamps /= 1.0 - chance;
#endif
  return max(sum, vec3(0.0));
}
