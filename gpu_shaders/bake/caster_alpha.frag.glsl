// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Alpha of a material's program at texture coordinates: those of `part` (lowest, size) over so many
// `pixels`. Goes behind
// the program.
#include "surfaces/material_at.glsl"

void main()
{
  ShadingPoint s;
  s.position = vec3(0.0);
  s.normal = s.true_normal = s.incoming = vec3(0.0, 0.0, 1.0);
  s.is_back = false;
  s.instance = 0;
  s.parametric = vec2(0.0);
  s.ray = RAY_IS_SHADOW;
  s.ray_length = 1.0;
  s.depths = vec3(0.0);
  s.more_depths = vec2(0.0);
  s.origin = vec3(0.0);
  s.random = float(turn.x);
  s.records = program_first;
  for (int k = 0; k <= ATTRIBUTES; k++) {
    s.attributes[k] = vec4(part.xy + part.zw * gl_FragCoord.xy / pixels, 0.0, 1.0);
  }
#ifdef PROGRAM_BUMP
  s.position_across = s.position_up = vec3(0.0);
  for (int k = 0; k <= ATTRIBUTES; k++) {
    s.attributes_across[k] = s.attributes_up[k] = vec4(0.0);
  }
#endif
  Material m = material_constants(int(material));
  m.normal = s.normal;
  material_program(s, m);
  color = vec4(m.alpha);
}
