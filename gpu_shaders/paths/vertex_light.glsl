// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface from which paths go on shows besides what they find: its emission, the base below its lobes, and
// lamps in lobes that are so wide that samples of lamps find them sooner than rays. (Lobes that let light through are
// left to the rays.)
#include "paths/path_vertex.glsl"

#ifdef PATH_LOBES
PathVertex lit_vertex;

vec3 followed_lobes(vec3 to_viewer, vec3 to_light, float density)
{
  if (!lit_vertex.follows) {
    return vec3(0.0);
  }
  float of_rays;
  vec3 value = scattered(lit_vertex.material, lit_vertex.facing, to_viewer, to_light, of_rays);
  return of_rays > 0.0 ? value * (density > 0.0 ? density / (density + of_rays) : 1.0) : vec3(0.0);
}
#endif

vec3 light_of_vertex(Surface s, PathVertex v, vec3 to_viewer)
{
#ifdef PATH_LOBES
  lit_vertex = v;
#endif
#ifdef PATHS_ALPHA
  if (!v.follows) {
    return v.material.alpha * shade_surface(s, to_viewer);
  }
#endif
  vec3 sum = s.emission * coat_passes(v.material, dot(v.facing.normal, to_viewer));
#if defined(PATHS_BASE) || defined(PATH_LOBES)
  float cos_viewer = dot(s.normal, to_viewer);
#ifdef PATHS_BASE
  Lobes lobes = base_lobes(s, base_share(v.material, v.facing, max(cos_viewer, 1e-4)), cos_viewer);
#ifdef SURFACE_SHEEN
  add_sheen(s, lobes);
#endif
#else
  Lobes lobes = base_lobes(s, vec3(0.0), cos_viewer);
#endif
  sum += lamps_on(s, lobes, to_viewer);
#ifdef PATHS_BASE
  sum += world_on(s, lobes, to_viewer);
#ifdef LIGHTING_INDIRECT
  sum += surfaces_on(s, lobes);
#endif
#endif
#endif
  return v.material.alpha * sum;
}
