// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What of a Material only some scenes' surfaces have.
#include "programs/surface.glsl"
#include "programs/material.glsl"

void add_layers(inout Surface s, Material m)
{
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
}
