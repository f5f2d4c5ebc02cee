// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Base color images at the places that exact.frag.glsl has left in `path_uv`: (uv, image), of the images
// `first_image` .. `first_image` + IMAGES - 1. Multiplies the base color. IMAGE_CASES is a CASE of each of the IMAGES
// samplers (renderer/surfaces/image_groups.py), as samplers cannot be indexed by what differs from pixel to pixel.
#define CASE(number, image) if (index == number) { texel = textureLod(image, place.xy, 0.0); }

void main()
{
  vec4 place = texelFetch(path_uv, ivec2(gl_FragCoord.xy), 0);
  int index = int(place.z + 0.5) - first_image;
  if (place.z < -0.5 || index < 0 || index >= IMAGES) {
    discard;
  }
  vec4 texel = vec4(1.0);
  IMAGE_CASES
  color = vec4(texel.rgb, 1.0);
}
