// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The ShadingPoint of a fragment of the scene's triangles. Goes behind the program. Needs the interpolated
// `world_position`, `attribute_0` and so on (ATTRIBUTE_CASES and
// NEIGHBOR_CASES take each), `instance_number`, the
// block `view` and the push constants `program_first` and `turn` (number of the sub-frame, 0).
#include "programs/chance.glsl"

// `normal`: unit, outward.
ShadingPoint point_of_fragment(vec3 normal)
{
  vec3 right = dFdx(world_position), up = dFdy(world_position);
  ShadingPoint s;
  s.position = world_position;
  s.origin = fetch_record(program_records, 0).xyz;
  vec3 to_eye = view.eye.xyz - world_position * view.eye.w;
  s.incoming = normalize(to_eye);
  s.is_back = !gl_FrontFacing;
  s.normal = gl_FrontFacing ? normal : -normal;
  s.true_normal = normalize(cross(right, up));
  s.true_normal *= dot(s.true_normal, s.incoming) < 0.0 ? -1.0 : 1.0;
  s.instance = instance_number;
  s.parametric = vec2(0.0);
  s.ray = RAY_IS_CAMERA;
  s.ray_length = view.eye.w > 0.0 ? length(to_eye) / view.eye.w : dot(to_eye, view.eye.xyz);
  s.depths = vec3(0.0);
  s.more_depths = vec2(0.0);
  s.random = chance_at(uvec2(gl_FragCoord.xy), turn);
  s.records = program_first;
  s.attributes[ATTRIBUTES] = vec4(0.0);
#ifdef PROGRAM_BUMP
  s.position_across = right;
  s.position_up = up;
  s.attributes_across[ATTRIBUTES] = s.attributes_up[ATTRIBUTES] = vec4(0.0);
  NEIGHBOR_CASES
#endif
  ATTRIBUTE_CASES
  return s;
}
