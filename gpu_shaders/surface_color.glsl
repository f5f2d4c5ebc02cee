// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Base colour of the batch's material. Needs the push constants of renderer/materials.py and the sampler `base_image`.

vec3 surface_color(vec2 uv, vec3 vertex_color)
{
  vec3 color = base_color * texture(base_image, uv * uv_transform.xy + uv_transform.zw).rgb;
  return uses_vertex_color > 0.5 ? color * vertex_color : color;
}
