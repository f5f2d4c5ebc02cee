// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Full-screen triangle at the depth of path_mask.frag.glsl.
void main()
{
  gl_Position = vec4(pos, 2.0 * PATH_DEPTH - 1.0, 1.0);
}
