// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Points of patches (renderer/indirect/points.py). Needs the sampler `patch_points`: of each patch PATCH_POINTS
// places, then as many normals; with the places the light sets of what they are on.
#include "common/records.glsl"

vec3 patch_place(int number, int point)
{
  return fetch_record(patch_points, (number * 2) * PATCH_POINTS + point).xyz;
}

#ifdef LIGHTING_LINKED
int patch_set(int number, int point)
{
  return int(fetch_record(patch_points, (number * 2) * PATCH_POINTS + point).w + 0.5);
}
#endif

vec3 patch_normal(int number, int point)
{
  return fetch_record(patch_points, (number * 2 + 1) * PATCH_POINTS + point).xyz;
}
