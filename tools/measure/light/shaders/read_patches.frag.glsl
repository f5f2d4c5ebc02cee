// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What patches say of places (a fragment each): irradiance. Needs the sampler `asked`: of each a place and a normal.
#include "patches/cells.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int number = (pixel.y << ROW_BITS) + pixel.x;
  color = vec4(patches_around(fetch_record(asked, 2 * number).xyz, fetch_record(asked, 2 * number + 1).xyz), 1.0);
}
