// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/records.glsl"

void main()
{
  gl_Position = world_to_clip * vec4(fetch_record(positions, gl_VertexID).xyz, 1.0);
}
