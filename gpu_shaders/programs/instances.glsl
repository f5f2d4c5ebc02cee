// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What programs know of the instance they are on: INSTANCE_VALUES records of each in `instance_table`
// (renderer/programs/instance_table.py).
//   0..2: rows from object to world; 3..5: rows from world to object; 6: color of the object; 7: random number, pass
//   index; 8, 9: scale and offset from object space to generated coordinates; 10: generated coordinates and 11: uv of
//   the instancer; from 12 on: values by name, in the order of the whole scene's list of names.
#include "programs/shading_point.glsl"

vec4 instance_record(ShadingPoint s, int number)
{
  return fetch_record(instance_table, INSTANCE_VALUES * s.instance + number);
}

vec3 to_object(ShadingPoint s, vec3 place)
{
  vec4 point = vec4(place, 1.0);
  return vec3(dot(instance_record(s, 3), point), dot(instance_record(s, 4), point), dot(instance_record(s, 5), point));
}

vec3 to_object_direction(ShadingPoint s, vec3 direction)
{
  return vec3(dot(instance_record(s, 3).xyz, direction), dot(instance_record(s, 4).xyz, direction),
              dot(instance_record(s, 5).xyz, direction));
}

vec3 to_world(ShadingPoint s, vec3 place)
{
  vec4 point = vec4(place, 1.0);
  return vec3(dot(instance_record(s, 0), point), dot(instance_record(s, 1), point), dot(instance_record(s, 2), point));
}

vec3 to_world_direction(ShadingPoint s, vec3 direction)
{
  return vec3(dot(instance_record(s, 0).xyz, direction), dot(instance_record(s, 1).xyz, direction),
              dot(instance_record(s, 2).xyz, direction));
}

// Normals go with the transposed inverse.
vec3 to_world_normal(ShadingPoint s, vec3 normal)
{
  return normal.x * instance_record(s, 3).xyz + normal.y * instance_record(s, 4).xyz +
         normal.z * instance_record(s, 5).xyz;
}

vec3 to_object_normal(ShadingPoint s, vec3 normal)
{
  return normal.x * instance_record(s, 0).xyz + normal.y * instance_record(s, 1).xyz +
         normal.z * instance_record(s, 2).xyz;
}

// `number`: in the program's own list. Before the program's parameters lie, backwards, its attributes' numbers in the
// scene's list of attributes, then those of its values of instances.
vec4 instance_attribute(ShadingPoint s, int number)
{
  int own = int(fetch_record(program_records, s.records - 1 - ATTRIBUTES - number).x + 0.5);
  return instance_record(s, 12 + own);
}
