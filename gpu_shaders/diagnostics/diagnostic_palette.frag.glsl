// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// One color per mirror (record `number` of `palette`) wherever it shows a surface. With MARKS, what was drawn there
// over it.
#include "common/records.glsl"
#include "diagnostics/diagnostic_mirror.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  MirrorPixel at = mirror_pixel(pixel);
  vec4 shown = shown_position(pixel, at);
  vec3 rgb = background;
  if (at.is_mirror && shown.w > 0.0) {
    rgb = fetch_record(palette, int(at.number + 0.5)).rgb;
    // A little of the shape of what is shown, or of the mirror, so that the color says where it is.
#ifdef ENVIRONMENT
    float facing = abs(dot(at.ray, at.normal));
#else
    float facing = abs(dot(texelFetch(reflected_normal, pixel, 0).xyz, normalize(shown.xyz - at.point)));
#endif
    rgb *= 0.45 + 0.55 * facing;
  }
#ifdef MARKS
  vec4 mark = texelFetch(marks, pixel, 0);
  rgb = mix(rgb, mark.rgb, mark.a);
#endif
  color = premultiplied(rgb, at);
}
