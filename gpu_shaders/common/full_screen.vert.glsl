// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Full-screen triangle; the fragment shader addresses pixels by gl_FragCoord.
void main()
{
  gl_Position = vec4(pos, 0.0, 1.0);
}
