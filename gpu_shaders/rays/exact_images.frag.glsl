// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Base color images at the places that exact.frag.glsl has left in `path_uv`: (uv, image), of the images
// `first_image` .. `first_image` + IMAGES - 1. Multiplies the base color.

void main()
{
  vec4 place = texelFetch(path_uv, ivec2(gl_FragCoord.xy), 0);
  int index = int(place.z + 0.5) - first_image;
  if (place.z < -0.5 || index < 0 || index >= IMAGES) {
    discard;
  }
  vec4 texel = vec4(1.0);
  // (Samplers cannot be indexed by what differs from pixel to pixel.)
  if (index == 0) {
    texel = textureLod(image_0, place.xy, 0.0);
  }
  else if (index == 1) {
    texel = textureLod(image_1, place.xy, 0.0);
  }
  else if (index == 2) {
    texel = textureLod(image_2, place.xy, 0.0);
  }
  else if (index == 3) {
    texel = textureLod(image_3, place.xy, 0.0);
  }
  else if (index == 4) {
    texel = textureLod(image_4, place.xy, 0.0);
  }
  else if (index == 5) {
    texel = textureLod(image_5, place.xy, 0.0);
  }
  else if (index == 6) {
    texel = textureLod(image_6, place.xy, 0.0);
  }
  else if (index == 7) {
    texel = textureLod(image_7, place.xy, 0.0);
  }
  color = vec4(texel.rgb, 1.0);
}
