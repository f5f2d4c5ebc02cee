// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a vertex shader hands on to a program. Needs the push constant `program_first` and VERTEX_CASES, which sets each
// of its attributes.

void set_program_inputs(Corner corner)
{
  instance_number = corner.instance;
  int index = gl_VertexID;
  VERTEX_CASES
}

