// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/surface_color.glsl"
#ifdef FOLLOWED
#include "surfaces/raised_normal.glsl"
#ifdef RELIEF
#include "surfaces/relief.glsl"
#endif
#endif

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
#if defined(RELIEF)
  normal = bent_normal(normal);
#elif defined(FOLLOWED)
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
  surface_color_out = vec4(surface_color(), shows);
#ifdef WITH_SCALARS
  surface_scalars = texture(scalars_image, uv * scalars_transform.xy + scalars_transform.zw + scalars_turn * uv.yx);
#endif
#ifdef NO_SCALARS
  surface_scalars = vec4(0.0);
#endif
}
