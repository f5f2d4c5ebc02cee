// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Full-screen triangle at the depth of one program (see program_classes.frag.glsl). Steps are a power of two: exact.
void main()
{
  gl_Position = vec4(pos, 2.0 * (program_number + 1.0) / PROGRAM_STEPS - 1.0, 1.0);
}
