// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Fermat's principle on the radial map; mirrors optics/fermat.py. The eye is homogeneous: w = 0 is at infinity. With
// REFRACTS the leg to the vertex counts its length times `solver.index`.
#include "solver_pieces/radial_map.glsl"

#ifdef REFRACTS
#define VERTEX_INDEX solver.index
#else
#define VERTEX_INDEX 1.0
#endif

vec3 path_gradient(vec4 eye, vec3 vertex, vec3 u, SurfaceSample at)
{
  vec3 h = towards_eye(eye, at.position) + VERTEX_INDEX * safe_unit(vertex - at.position);
  float along = dot(h, u);
  return -(along * at.gradient + at.radius * (h - along * u));
}

// `side` is -1 where the inner side reflects.
bool is_reflection_side(vec4 eye, vec3 vertex, SurfaceSample at, float side)
{
  vec3 normal = side * surface_normal(at);
  return dot(normal, towards_eye(eye, at.position)) > 0.0 && dot(normal, vertex - at.position) > 0.0;
}

// The opposite of a direction where a hollow mirror reflects better there.
vec3 on_hollow_side(vec4 eye, vec3 vertex, vec3 u)
{
  SurfaceSample ahead = sample_surface(u);
  SurfaceSample behind = sample_surface(-u);
  vec3 ahead_bisector = safe_unit(towards_eye(eye, ahead.position) + safe_unit(vertex - ahead.position));
  vec3 behind_bisector = safe_unit(towards_eye(eye, behind.position) + safe_unit(vertex - behind.position));
  bool turn = dot(behind_bisector, surface_normal(behind)) < dot(ahead_bisector, surface_normal(ahead));
  return turn ? -u : u;
}

float leg_change(vec3 x, vec3 start, vec3 end)
{
  float lengths = length(x - start) + length(x - end);
  return dot(end - start, (start - x) + (end - x)) / max(lengths, 1e-30);
}

// Path length by `end` minus path length by `start`, without subtracting two long lengths.
float path_change(vec4 eye, vec3 vertex, vec3 start, vec3 end)
{
  float to_eye = eye.w > 0.0 ? leg_change(eye.xyz, start, end) : -dot(end - start, eye.xyz);
  return to_eye + VERTEX_INDEX * leg_change(vertex, start, end);
}
