// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The outputs of `fills` (renderer/programs/buffers.py). With PROGRAM behind material_at.glsl.

#ifdef PROGRAM
void fill_buffers(Material m)
{
#ifdef PROGRAM_SCALARS
  scalars_out = packed_scalars(m);
#endif
#ifdef PROGRAM_SHINE
  shine_out = packed_shine(m);
#endif
#ifdef PROGRAM_LAYERS
  layers_out = packed_layers(m);
#endif
}
#else
// Of a material without a program: nobody looks at them.
void fill_buffers()
{
#ifdef PROGRAM_SCALARS
  scalars_out = vec4(0.0);
#endif
#ifdef PROGRAM_SHINE
  shine_out = vec4(0.0);
#endif
#ifdef PROGRAM_LAYERS
  layers_out = uvec4(0u);
#endif
}
#endif
