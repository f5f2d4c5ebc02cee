// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Base color of the batch's material. Needs the push constants of renderer/surfaces/materials.py and, unless PLAIN,
// its sampler `base_image` and the interpolated `uv` and `vertex_color`.

vec3 surface_color()
{
#ifdef PLAIN
  return base_color;
#else
  vec2 place = uv * uv_transform.xy + uv_transform.zw + uv_turn * uv.yx;
  vec3 color = base_color * texture(base_image, place).rgb;
  return uses_vertex_color > 0.5 ? color * vertex_color : color;
#endif
}
