// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/geometry.glsl"

void main()
{
  Corner corner = fetch_corner(gl_VertexID);
  world_position = corner.position;
  gl_Position = view.view_to_clip * (view.world_to_view * vec4(corner.position, 1.0));
}
