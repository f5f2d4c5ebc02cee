// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Vertex colors as renderer/geometry/chunk.py packs them into one float.

vec3 unpack_vertex_color(float packed_color)
{
  // A whole number that takes all the digits of a float: half of one more would round it up.
  int levels = int(packed_color);
  vec3 root = vec3(levels & 255, (levels >> 8) & 255, levels >> 16) / 255.0;
  return root * root;
}
