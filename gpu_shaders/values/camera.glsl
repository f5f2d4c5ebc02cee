// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// What the camera sees: its space has Z ahead. Needs the uniform block `view` (renderer/surfaces/view_block.py).

vec3 view_place(vec3 place)
{
  return (view.world_to_view * vec4(place, 1.0)).xyz * vec3(1.0, 1.0, -1.0);
}

vec3 view_direction(vec3 direction)
{
  return mat3(view.world_to_view) * direction * vec3(1.0, 1.0, -1.0);
}

vec3 view_to_world_direction(vec3 direction)
{
  return (direction * vec3(1.0, 1.0, -1.0)) * mat3(view.world_to_view);
}

vec3 view_to_world(vec3 place)
{
  return view_to_world_direction(place - view_place(vec3(0.0)));
}

// From 0 to 1 across the picture.
vec3 view_window(vec3 place)
{
  vec4 clip = view.view_to_clip * (view.world_to_view * vec4(place, 1.0));
  return vec3(0.5 + 0.5 * clip.xy / clip.w, 0.0);
}

vec3 view_window_of_direction(vec3 direction)
{
  vec4 clip = view.view_to_clip * vec4(mat3(view.world_to_view) * direction, 1.0);
  return vec3(0.5 + 0.5 * clip.xy / clip.w, 0.0);
}
