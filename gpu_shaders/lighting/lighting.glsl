// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light on a surface point towards a viewer: lamps with shadows, the world with its shadows, emission.
// Needs the samplers and the uniform block of renderer/lighting/lighting.py (lighting_piece).
//
// lighting_data: HEADER_RECORDS records, then LAMP_RECORDS for each lamp, then DIRECTION_RECORDS for each direction.
//   0: number of lamps, number of world directions, 1 for a world image, turn of the picked lamp (lamps.glsl);
//   1: world color, brightest that is no sun; 2..4: rows of the rotation from world to image directions; 5: weight of
//   each direction where there is no image; 6: with LIGHTING_PARTS, whether the camera, diffuse and glossy parts of
//   surfaces see the world; 7: with LIGHTING_CLAMPED, the most that a lamp's sample brings after bounces (the mean of
//   its channels). Without lamps or directions the first record is dark: the loops over them run at least once, as a
//   software renderer runs the body of a `for` once more than it needs.

// With LIGHTING_LINKED or LIGHTING_SHADOWS_LINKED there is a record of each lamp from LINK_RECORDS on: bits of the
// light sets that it lights, and of the shadow sets in the way of its light.

// (Includes are put in place before defines are known: what others include too must not be behind one.)
#include "common/hash.glsl"
#include "common/records.glsl"
#include "programs/surface.glsl"
#include "surfaces/light_sets.glsl"
#if defined(RAY_SHADOWS) || defined(WORLD_RAYS)
#ifdef LIGHTING_ALPHA
#define LIGHT_THROUGH
#include "rays/light_through.glsl"
#endif
#include "rays/ray_walk.glsl"

#define SHADOW_END 0.9999

// Share of light that gets here the unit way from nearer than `range`, through what casts shadows.
#ifdef LIGHTING_ALPHA
#define LIT vec3
#define LIT_CHANNELS 3.0
#else
#define LIT float
#define LIT_CHANNELS 1.0
#endif
#ifdef LIGHTING_SHADOWS_LINKED
// Bits of the shadow sets in the way of the next lamp's light.
int lamp_blockers = EVERY_SET;
#endif

LIT lit_by_ray(Surface s, vec3 to_light, float range)
{
#ifdef LIGHTING_SHADOWS_LINKED
  walk_blockers = lamp_blockers;
  lamp_blockers = EVERY_SET;
#endif
  Hit hit = walk(off_surface(s.position, s.normal), to_light, range * SHADOW_END, CASTS_SHADOWS, 0.0, true);
#ifdef LIGHTING_ALPHA
  return walked_light;
#else
  return hit.instance < 0 ? 1.0 : 0.0;
#endif
}
#endif
#include "lighting/ggx.glsl"
#include "lighting/shadow.glsl"
#include "emitters/lamp_looks.glsl"
#include "lighting/world_light.glsl"
#include "lighting/lamps.glsl"
#include "emitters/lamps_seen.glsl"
#ifdef LIGHTING_INDIRECT
#define SMOOTH_CELLS
#include "patches/cells.glsl"
#endif

#ifdef LIGHTING_INDIRECT
// Radiance towards the viewer of what arrives from other surfaces, as their patches know it.
vec3 surfaces_on(Surface s, Lobes lobes)
{
  vec3 arriving = patches_around(s.position, s.normal) / LIGHTING_PI;
  vec3 sum = (lobes.diffuse + lobes.specular_albedo) * arriving;
#ifdef SURFACE_TRANSLUCENT
  sum += lobes.translucent * patches_around(s.position, -s.normal) / LIGHTING_PI;
#endif
  return sum;
}
#endif

#ifdef LIGHTING_CAUSTICS
#include "caustics/thrown.glsl"
#endif

#ifdef LIGHTING_LINKED
// The surface as something of a light set sees it shine; below 0: as the camera does.
Surface shining_on(Surface s, int number)
{
  s.emission *= number < 0 || is_for_set(s.shines_on, number) ? 1.0 : 0.0;
  return s;
}
#endif

vec3 emission_of(Surface s, Lobes lobes)
{
#if defined(SURFACE_SHEEN) || defined(SURFACE_COAT)
  return s.emission * lobes.above;
#else
  return s.emission;
#endif
}

// Outgoing radiance. `to_viewer`: unit. The normal is that of the viewer's side; bent, it may turn away all the same,
// and the surface is lit by it, as in Cycles.
vec3 shade_surface(Surface s, vec3 to_viewer)
{
  Lobes lobes = lobes_of(s, dot(s.normal, to_viewer));
  vec3 sum = emission_of(s, lobes) + lamps_on(s, lobes, to_viewer) + world_on(s, lobes, to_viewer);
#if defined(LIGHTING_INDIRECT) && !defined(GATHERED)
  sum += surfaces_on(s, lobes);
#endif
#ifdef LIGHTING_CAUSTICS
  sum += thrown_on(s, lobes, to_viewer);
#endif
  return sum;
}

// What a mirror shows besides its reflection, of which sheen, coat and tints are left out: emission and the diffuse
// base below the reflecting lobe.
vec3 shade_under_mirror(Surface s, vec3 to_viewer)
{
#ifdef SURFACE_TINT
  s.specular_tint = vec3(1.0);
#endif
#ifdef SURFACE_SHEEN
  s.sheen = vec3(0.0);
#endif
#ifdef SURFACE_COAT
  s.coat_weight = 0.0;
#endif
  Lobes lobes = lobes_of(s, dot(s.normal, to_viewer));
  vec3 sum = emission_of(s, lobes);
  vec3 below = lobes.diffuse;
#ifdef SURFACE_TRANSLUCENT
  below += lobes.translucent;
#endif
  if (largest(below) > 0.0) {
    lobes.metal_weight = lobes.dielectric_weight = lobes.specular_albedo = vec3(0.0);
    sum += lamps_on(s, lobes, to_viewer) + world_on(s, lobes, to_viewer);
#ifdef LIGHTING_INDIRECT
    sum += surfaces_on(s, lobes);
#endif
  }
  return sum;
}
