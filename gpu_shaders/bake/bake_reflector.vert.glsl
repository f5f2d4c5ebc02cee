// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh seen from the origin of the map frame through one face of a cube.
void main()
{
  map_position = position;
  map_normal = normal;
  float forward = dot(axis_forward, position);
  // Only the near plane clips; depth comes from the fragment shader.
  gl_Position = vec4(dot(axis_s, position), dot(axis_t, position), forward - 2.0 * near, forward);
}
