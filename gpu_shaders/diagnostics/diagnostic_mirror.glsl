// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The mirror at this pixel, for the diagnostic views: as mirror_pixel.glsl, with the push constant `weight`.
#include "surfaces/chosen_mirrors.glsl"
#include "surfaces/mirror_pixel.glsl"

vec4 premultiplied(vec3 rgb, MirrorPixel at)
{
#ifdef WITH_CHOICE
  if (!is_chosen(at.number)) {
    return vec4(0.0);
  }
#endif
  return at.is_mirror ? vec4(rgb, 1.0) * weight : vec4(0.0);
}
