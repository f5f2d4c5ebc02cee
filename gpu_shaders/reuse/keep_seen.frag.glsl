// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a pixel shows, for the frames after this one: a surface that is seen itself, the background, or of a mirror the
// background where nothing else is drawn over it (renderer/reuse/kept_frame.py). What lets light through, and mirrors
// that are not chosen, show several things at once: they count as surfaces, and as SHOWS_SEVERAL.
#include "lighting/mirror_tint.glsl"
#include "surfaces/chosen_mirrors.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(seen_position, pixel, 0);
  float number = texelFetch(seen_color, pixel, 0).w;
  tint_out = vec4(1.0, 1.0, 1.0, number == -1.0 ? 0.0 : SHOWS_SEVERAL - max(number, 0.0));
  shown_out = vec4(position.xyz, floor(position.w + 0.5));
  if (number > 0.5 && is_chosen(number)) {
    vec4 facing = texelFetch(seen_normal, pixel, 0);
    vec3 incoming = normalize(position.xyz * view.eye.w - view.eye.xyz);
    vec3 tint = mirror_tint(int(floor(facing.w + 0.5)), texelFetch(seen_color, pixel, 0).rgb,
                            max(-dot(facing.xyz, incoming), 0.0));
    shown_out = vec4(reflect(incoming, facing.xyz), 0.0);
    tint_out = vec4(min(tint, vec3(6e4)), number);
  }
  else if (number == 0.0) {
    // (As `direction_at` of a picture's corner would: from the near end on.)
    vec2 place = 2.0 * (gl_FragCoord.xy / vec2(textureSize(seen_color, 0))) - 1.0;
    vec4 far = view.clip_to_world * vec4(place, 1.0, 1.0), near = view.clip_to_world * vec4(place, -1.0, 1.0);
    shown_out = vec4(normalize(far.xyz * near.w - near.xyz * far.w), 0.0);
    tint_out.w = 0.0;
  }
  else if (number == HOLE) {
    tint_out.w = SERVES_NONE;
  }
}
