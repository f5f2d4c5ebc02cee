// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The reflector as a radial cube map (r, grad r), relative to its star center; mirrors optics/fermat.py `sample`.
// Needs the sampler (FLOAT_CUBE) `radial`.
#include "common/vectors.glsl"

struct SurfaceSample {
  vec3 position;
  float radius;
  vec3 gradient;  // tangential
};

SurfaceSample sample_surface(vec3 u)
{
  vec4 texel = textureLod(radial, u, 0.0);
  SurfaceSample at;
  at.radius = texel.x;
  at.gradient = texel.yzw - dot(texel.yzw, u) * u;
  at.position = at.radius * u;
  return at;
}

vec3 surface_normal(SurfaceSample at)
{
  return safe_unit(at.position - at.gradient);
}
