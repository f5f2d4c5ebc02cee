// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A vertex of a path out of surface buffers: its material, how it faces the ray, whether the path goes on there. Needs
// the samplers `vertex_position`, `vertex_normal`, `vertex_color`, those of material_at.glsl, and with
// PATHS_ANISOTROPY `object_frames` (renderer/paths/object_frames.py).
#include "surfaces/material_at.glsl"
#include "surfaces/material_number.glsl"
#include "paths/scatter.glsl"

struct PathVertex {
  vec3 position;
  float object_id;
  int index;        // of the material
  Material material;
  Facing facing;
  bool follows;     // all its lobes are followed; else light only goes straight on where it is not there
};

#ifdef PATHS_ANISOTROPY
// About the object's Z axis, through the middle of its box.
vec3 tangent_about_z(vec3 position, float object_id)
{
  int record = FRAME_RECORDS * int(object_id + 0.5);
  vec4 place = vec4(position, 1.0);
  vec4 along_x = fetch_record(object_frames, record + 2);
  vec4 along_y = fetch_record(object_frames, record + 3);
  float across_x = dot(fetch_record(object_frames, record), place);
  float across_y = dot(fetch_record(object_frames, record + 1), place);
  vec3 tangent = across_x * along_y.xyz - across_y * along_x.xyz;
  return normalize(tangent + vec3(0.0, 0.0, 1e-20));
}
#endif

PathVertex vertex_at(ivec2 pixel)
{
  vec4 place = texelFetch(vertex_position, pixel, 0);
  vec4 normal = texelFetch(vertex_normal, pixel, 0);
  vec4 color = texelFetch(vertex_color, pixel, 0);
  PathVertex v;
  v.position = place.xyz;
  v.object_id = place.w;
  v.index = material_number(normal.w);
  v.material = material_at(pixel, v.index, color.rgb);
  v.facing.normal = normal.xyz;
  v.facing.tangent = vec3(0.0);
#ifdef PATHS_ANISOTROPY
  v.facing.tangent = tangent_about_z(place.xyz, place.w);
#endif
  v.facing.is_back = is_back_face(normal.w);
  v.follows = color.w > 0.5 || v.material.transmission > 0.0;
  return v;
}
