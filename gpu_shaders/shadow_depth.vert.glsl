// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
void main()
{
  gl_Position = world_to_clip * vec4(pos, 1.0);
}
