// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a vertex shader hands on to a program. Needs the push constant `program_first` and VERTEX_CASES, which sets
// each of its attributes.
#include "common/corner_attributes.glsl"
#include "common/corner_instances.glsl"

void set_program_inputs(int index)
{
  instance_number = instance_of_corner(index);
  VERTEX_CASES
}

