// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where a program is asked (scene/programs), and what it may look up there. Needs the samplers `program_records`
// (parameters of all programs) and, with PROGRAM_INSTANCE, `instance_table` (scene/programs/instances.glsl), and
// ATTRIBUTES, how many attributes it reads.
#include "common/records.glsl"

#from scene.programs.bits import RAY_IS_CAMERA, RAY_IS_REFLECTION, RAY_IS_TRANSMISSION, RAY_IS_DIFFUSE, RAY_IS_GLOSSY
#from scene.programs.bits import RAY_IS_SINGULAR, RAY_IS_SHADOW

struct ShadingPoint {
  vec3 position;      // world space about `origin`; of a world its direction
  vec3 origin;        // of all places here, in world space (renderer/placement.py)
  vec3 normal;        // unit shading normal, turned to the side that the ray comes from
  vec3 true_normal;   // of the triangle, turned likewise
  vec3 incoming;      // unit, towards where the ray comes from
  bool is_back;       // the back of the triangle is seen
  int instance;       // number of a row in instance_table
  vec2 parametric;    // weights of the second and third corner
  int ray;            // RAY_IS_ bits
  float ray_length;
  vec3 depths;        // bounces, diffuse bounces, glossy bounces
  vec2 more_depths;   // transmission bounces, transparent bounces
  float random;       // 0 to 1: which of mixed shaders
  int records;        // first of the program's parameters
  vec4 attributes[ATTRIBUTES + 1];  // (GLSL has no empty arrays)
#ifdef PROGRAM_BUMP
  // What changes on the way to two neighbors on the surface, a pixel's width away.
  vec3 position_across, position_up;
  vec4 attributes_across[ATTRIBUTES + 1], attributes_up[ATTRIBUTES + 1];
#endif
};

// Parameters of the program that is asked at the ShadingPoint `s`.
#define P(number) fetch_record(program_records, s.records + (number))

#ifdef PROGRAM_BUMP
ShadingPoint point_across(ShadingPoint s)
{
  s.position += s.position_across;
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes[k] += s.attributes_across[k];
  }
  return s;
}

ShadingPoint point_up(ShadingPoint s)
{
  s.position += s.position_up;
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes[k] += s.attributes_up[k];
  }
  return s;
}
#endif

// Before a program's parameters lie, backwards, the numbers of its attributes in the scene's list of attributes.
int attribute_number(ShadingPoint s, int number)
{
  return int(fetch_record(program_records, s.records - 1 - number).x + 0.5);
}
