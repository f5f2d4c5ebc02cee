// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Draws a sphere map out of a cube map: the inverse of the lookup in environment_sphere.glsl.

void main()
{
  vec2 place = 2.0 * gl_FragCoord.xy / map_size - 1.0;
  // The ball's normal is (place, height). Outside of the disk is what its rim has.
  float height = sqrt(max(1.0 - dot(place, place), 0.0));
  vec3 r = 2.0 * height * vec3(place, height) - vec3(0.0, 0.0, 1.0);
  color = textureLod(environment, r.x * environment_right + r.y * environment_up + r.z * environment_axis, 0.0);
}
