// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh drawn where its UV map places it: the unit square fills the target.
void main()
{
  map_position = position;
  map_normal = normal;
  map_du = du;
  map_dv = dv;
  gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0);
}
