// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Images at the texture coordinates that a step has left in `path_uv` (uv, whether a surface is there): of base
// colors, to be multiplied with them, or with OF_SCALARS of roughness, metallic, transmission and alpha. Of the images
// `first_image` .. `first_image` + IMAGES - 1 here, as samplers cannot be indexed by what differs from pixel to pixel.
#include "surfaces/material_records.glsl"
#include "surfaces/material_number.glsl"
#define CASE(number, image) if (index == number) { texel = textureLod(image, place, 0.0); }
#ifdef OF_SCALARS
#define TRANSFORM 11
#else
#define TRANSFORM 3
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 at = texelFetch(path_uv, pixel, 0);
  int record = MATERIAL_RECORDS * material_number(texelFetch(vertex_normal, pixel, 0).w) + TRANSFORM;
  vec4 transform = fetch_record(materials, record);
  vec4 image = fetch_record(materials, record + 1);
  int index = int(image.x + (image.x < 0.0 ? -0.5 : 0.5)) - first_image;
  if (at.w < 0.5 || image.x < -0.5 || index < 0 || index >= IMAGES) {
    discard;
  }
  vec2 place = at.xy * transform.xy + transform.zw + image.yz * at.yx;
  vec4 texel = vec4(1.0);
  IMAGE_CASES
#ifdef OF_SCALARS
  color = texel;
#else
  color = vec4(texel.rgb, 1.0);
#endif
}
