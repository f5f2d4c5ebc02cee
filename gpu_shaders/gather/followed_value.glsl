// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Of the lobe to a light above the surface, times its cosine.
vec3 lobe_value(Lobes lobes, vec3 normal, vec3 to_viewer, vec3 to_light)
{
  float cosine = max(dot(normal, to_light), 0.0);
  return lobes.alpha > GGX_SINGULAR_ALPHA ? glossy_lobe(lobes, lobes.alpha, normal, to_viewer, to_light, cosine) :
                                            vec3(0.0);
}

// And of the base.
vec3 followed_value(Lobes lobes, vec3 normal, vec3 to_viewer, vec3 to_light)
{
  float cosine = max(dot(normal, to_light), 0.0);
  return lobes.diffuse * (cosine / LIGHTING_PI) + lobe_value(lobes, normal, to_viewer, to_light);
}
