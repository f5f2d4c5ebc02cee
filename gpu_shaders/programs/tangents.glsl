// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "programs/instances.glsl"

// Turns about `normal` from the surface's own tangent, about the object's Z axis through the middle of its box
// (`paths/path_vertex.glsl`), to another one.
float turns_to_tangent(ShadingPoint s, vec3 normal, vec3 tangent)
{
  vec3 generated = to_object(s, s.position) * instance_record(s, 8).xyz + instance_record(s, 9).xyz - 0.5;
  vec3 own = to_world_direction(s, vec3(-generated.y, generated.x, 0.0));
  own -= dot(own, normal) * normal;
  float along = dot(own, tangent);
  float across = dot(cross(own, tangent), normal);
  return abs(along) + abs(across) > 0.0 ? atan(across, along) / 6.283185307 : 0.0;
}
