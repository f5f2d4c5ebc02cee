// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// With PROGRAM what the material's program makes of the surface, else its constants. With FOLLOWED rays go on from
// here; with SMOOTH the normal stays that of the mesh.
#include "surfaces/material_records.glsl"
#ifdef FOLLOWED
#include "surfaces/raised_normal.glsl"
#endif
#ifdef PROGRAM
#include "surfaces/material_at.glsl"
#include "programs/point_of_fragment.glsl"
#endif
#include "surfaces/fill_buffers.glsl"

void main()
{
#ifdef LINEAR_DEPTH
  // `depths`: near and far end, and the distance whose depth is 1. In floating point that is as exact near as far.
  float distance_ahead = 1.0 / gl_FragCoord.w;
  if (distance_ahead > depths.y) {
    discard;
  }
  gl_FragDepth = distance_ahead / depths.z;
#endif
  vec3 normal = normalize(world_normal);
#ifdef PROGRAM
  Material m = material_constants(int(material));
  ShadingPoint s = point_of_fragment(normal);
  m.normal = s.normal;
  material_program(s, m);
  vec3 color = m.base_color;
#ifndef SMOOTH
  normal = gl_FrontFacing ? m.normal : -m.normal;
#endif
#else
  vec3 color = base_color;
#endif
#ifdef FOLLOWED
  normal = raised_normal(normal);
#endif
  surface_position = vec4(world_position, ids.x);
  surface_normal = vec4(gl_FrontFacing ? normal : -normal, material);
  // (See SurfaceBuffer; a hole has a material below 0.)
  float shows = material < -0.5 ? -2.0 : (ids.y > 0.5 ? ids.y : -1.0);
#ifdef PATHS
  // (See PathVertices.)
  surface_normal.w += gl_FrontFacing ? 0.0 : 0.25;
  shows = shows == -1.0 && seen_through > 0.5 ? SEEN_THROUGH : shows;
#endif
  surface_color_out = vec4(color, shows);
#ifdef PROGRAM
  fill_buffers(m);
#else
  fill_buffers();
#endif
}
