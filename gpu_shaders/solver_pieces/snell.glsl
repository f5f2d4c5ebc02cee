// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Snell's law on the radial map; mirrors optics/snell.py. Needs REFRACTS.
#include "solver_pieces/fermat.glsl"

// The direction beyond the surface of the line of sight to a point of it; whether the eye sees the point from its side
// and is not reflected totally.
bool refracted_at(SurfaceSample at, out vec3 ray)
{
  vec3 normal = solver.side * surface_normal(at);
  vec3 to_eye = towards_eye(solver.eye, at.position);
  float cosine = dot(to_eye, normal);
  vec3 across = to_eye - cosine * normal;
  float inner = 1.0 - dot(across, across) / (solver.index * solver.index);
  ray = -across / solver.index - sqrt(max(inner, 0.0)) * normal;
  return cosine > 0.0 && inner >= 0.0;
}

bool is_refraction_side(vec3 vertex, SurfaceSample at)
{
  vec3 normal = solver.side * surface_normal(at);
  return dot(normal, towards_eye(solver.eye, at.position)) > 0.0 && dot(normal, vertex - at.position) < 0.0;
}

// Minus the cosine of the angle between the refracted line of sight and the way to the vertex; 2 where there is none.
float snell_error(vec3 vertex, SurfaceSample at)
{
  vec3 ray;
  return refracted_at(at, ray) ? -dot(ray, safe_unit(vertex - at.position)) : 2.0;
}
