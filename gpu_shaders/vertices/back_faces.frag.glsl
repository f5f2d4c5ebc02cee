// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Distance from the eye to the reflector's nearest back face (Roger & Holzschuch 2006, section 3.3.6); front faces are
// culled.

void main()
{
  vec3 to_point = world_position - view.eye.xyz * view.eye.w;
  eye_distance = view.eye.w > 0.0 ? length(to_point) : -dot(to_point, view.eye.xyz);
}
