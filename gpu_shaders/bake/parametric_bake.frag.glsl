// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Position, shading normal and tangents of a mesh in the map frame; w is 1 where there is a triangle.
void main()
{
  surface_point = vec4(map_position, 1.0);
  surface_normal = vec4(map_normal, 1.0);
  surface_du = vec4(map_du, 1.0);
  surface_dv = vec4(map_dv, 1.0);
}
