// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outputs of rays for light between surfaces: position, normal and color of what they meet, and with WITH_HITS by what
// materials' programs find it.
#include "surfaces/light_sets.glsl"
#ifdef LIGHTING_LINKED
// Of what the ray has left.
int set_on_leaving = 0;
#endif

void write_no_surface(vec3 start)
{
  surface_position = vec4(start, 0.0);
  surface_normal = surface_color_out = vec4(0.0);
#ifdef WITH_HITS
  hit_out = vec4(0.0);
#endif
}

void write_surface(Hit hit, RaySurface surface)
{
  surface_position = vec4(surface.position, surface.object_id);
#ifdef LIGHTING_LINKED
  surface_position.w = with_set(surface.object_id, set_on_leaving);
#endif
  surface_normal = vec4(surface.normal, float(surface.material) + (surface.is_back ? 0.25 : 0.0));
  surface_color_out = vec4(fetch_record(materials, MATERIAL_RECORDS * surface.material + 2).rgb, 0.0);
#ifdef WITH_HITS
  hit_out = packed_hit(hit);
#endif
}
