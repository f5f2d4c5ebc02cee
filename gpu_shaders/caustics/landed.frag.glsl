// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where the light of corners has landed: on surfaces from which no path goes on. What has only gone straight on has
// arrived as a lamp's light does, and what comes after the last mirror that is followed does not count.
#include "paths/path_state.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 throughput = texelFetch(path_throughput, pixel, 0);
  PathState state = unpack_state(throughput.w);
  if (state.ends || state.reflected + state.transmitted == 0) {
    discard;
  }
  position_out = texelFetch(vertex_position, pixel, 0);
  position_out.w = floor(position_out.w);
  normal_out = texelFetch(vertex_normal, pixel, 0);
  way_out = vec4(way_direction(texelFetch(path_way, pixel, 0)), float(throughput.w));
  power_out = vec4(throughput.rgb, 1.0);
}
