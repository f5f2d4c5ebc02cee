// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What each point of a patch counts: all that are half as open as the most open one, alike.

vec4 weights_of_points(vec4 open)
{
  float most = max(max(open.x, open.y), max(open.z, open.w));
  return most > 0.0 ? vec4(greaterThanEqual(open, vec4(0.5 * most))) : vec4(0.0);
}
