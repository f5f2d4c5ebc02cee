// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "programs/shading_point.glsl"

// A normal that nodes make, of length 1; the surface's own where it has no length.
vec3 unit_normal(ShadingPoint s, vec3 normal)
{
  float size = length(normal);
  return size > 0.0 ? normal / size : s.normal;
}
