// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The reflector as textures of its parameters; mirrors `SampledMap` of optics/solvers/secant_uv.py. Needs the samplers
// (FLOAT_2D) `surface_point`, `surface_du`, `surface_dv` and (FLOAT_CUBE) `uv_of_direction`
// (renderer/mirrors/parametric_map.py).
#include "common/vectors.glsl"

struct ParametricSample {
  vec3 position;
  vec3 du;
  vec3 dv;
  vec3 normal;  // outwards
};

ParametricSample sample_parametric(vec2 uv)
{
  vec4 point = textureLod(surface_point, uv, 0.0);
  vec4 du = textureLod(surface_du, uv, 0.0);
  vec4 dv = textureLod(surface_dv, uv, 0.0);
  ParametricSample at;
  at.position = point.xyz;
  at.normal = safe_unit(vec3(point.w, du.w, dv.w));
  at.du = du.xyz - dot(du.xyz, at.normal) * at.normal;
  at.dv = dv.xyz - dot(dv.xyz, at.normal) * at.normal;
  return at;
}

// Texel (radius, u, v, flags) that a direction meets: between texels u would be wrong at the seam of a map that wraps.
vec4 map_texel(vec3 direction)
{
  vec3 size = abs(direction);
  float largest = max(max(size.x, size.y), size.z);
  float resolution = float(textureSize(uv_of_direction, 0).x);
  vec3 on_cube = direction / max(largest, 1e-30);
  vec3 centers = (floor((on_cube * 0.5 + 0.5) * resolution) + 0.5) / resolution * 2.0 - 1.0;
  // The last texel ends at 1.
  centers = clamp(centers, 1.0 / resolution - 1.0, 1.0 - 1.0 / resolution);
  bool on_x = size.x >= size.y && size.x >= size.z;
  bool on_y = !on_x && size.y >= size.z;
  centers = vec3(on_x ? on_cube.x : centers.x,
                 on_y ? on_cube.y : centers.y,
                 on_x || on_y ? centers.z : on_cube.z);
  return textureLod(uv_of_direction, centers, 0.0);
}

struct MapKind {
  vec2 wraps;  // 1 where a parameter wraps, else 0
  bool is_open;
};

MapKind map_kind()
{
  int flags = int(textureLod(uv_of_direction, vec3(1.0, 0.0, 0.0), 0.0).w + 0.5);
  return MapKind(vec2(flags & 1, (flags >> 1) & 1), (flags & 4) != 0);
}

// Parameters that do not wrap, brought into the map.
vec2 clamped(vec2 wraps, vec2 uv)
{
  return mix(clamp(uv, 0.0, 1.0), uv, wraps);
}

// What lies between parameters, the nearer way around.
vec2 nearer(vec2 wraps, vec2 difference)
{
  return difference - wraps * roundEven(difference);
}
