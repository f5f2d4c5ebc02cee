// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// For renderer/proofs/walk.py: what rays hit, one for each pixel. hit_place: position and object_id, 0 where nothing
// is hit; hit_facing: the shading normal there, and the distance.
#include "rays/ray_walk.glsl"
#include "rays/ray_surface.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 origin = texelFetch(ray_origins, pixel, 0).xyz;
  vec3 direction = texelFetch(ray_directions, pixel, 0).xyz;
  Hit hit = walk(origin, direction, 3e38, SEEN_IN_MIRRORS, 0.0, false);
  hit_place = hit_facing = vec4(0.0);
  if (hit.instance >= 0) {
    RaySurface surface = surface_of_hit(hit, origin, direction);
    hit_place = vec4(surface.position, surface.object_id);
    hit_facing = vec4(surface.normal, hit.range);
  }
}
