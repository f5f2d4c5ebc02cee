// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/status.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float from_center = length(gl_PointCoord - 0.5);
  if (from_center > 0.5 || texelFetch(mirror_color, pixel, 0).w != mirror) {
    discard;
  }
  int status = int(vertex_status + 0.5);
  if (status == REFLECTED) {
    vec3 seen_point = texelFetch(mirror_position, pixel, 0).xyz;
    vec4 shown = texelFetch(reflected_position, pixel, 0);
    // On a part of the mirror behind this one, or covered by something nearer in the reflection.
    vec4 clip = view.view_to_clip * (view.world_to_view * vec4(seen_point, 1.0));
    float pixel_size = 2.0 * clip.w / (view.view_to_clip[1][1] * float(textureSize(mirror_color, 0).y));
    if (distance(reflection_point, seen_point) > 8.0 * point_size * pixel_size ||
        (shown.w > 0.0 && length_to_vertex > 1.02 * distance(shown.xyz, seen_point)))
    {
      discard;
    }
  }
  vec3 rgb = status == REFLECTED ? reflected_color : status == HIDDEN ? hidden_color : failed_color;
  // A dark rim keeps a point apart from its neighbors and from surfaces of its own color.
  mark = vec4(from_center > 0.36 ? 0.15 * rgb : status == HIDDEN ? 0.6 * rgb : rgb, 1.0);
}
