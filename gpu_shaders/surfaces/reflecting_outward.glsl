// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Shading normals that lean too far for the facet they are on: smooth ones of coarse meshes, and bent ones.

// Steepest normal towards `bent` whose mirrored ray leaves the surface (Cycles' ensure_valid_specular_reflection).
// `facing`: geometric normal; `to_eye`; all unit, on one side of the surface.
vec3 reflecting_outward(vec3 facing, vec3 to_eye, vec3 bent)
{
  float eye_z = dot(to_eye, facing);
  float least = min(0.9 * eye_z, 0.01);
  if (dot(facing, 2.0 * dot(bent, to_eye) * bent - to_eye) >= least) {
    return bent;
  }
  vec3 aside = bent - dot(bent, facing) * facing;
  if (dot(aside, aside) < 1e-12) {
    return facing;
  }
  aside = normalize(aside);
  float eye_x = dot(to_eye, aside);
  float a = eye_x * eye_x + eye_z * eye_z;
  float b = 2.0 * (a + eye_z * least);
  float c = (least + eye_z) * (least + eye_z);
  float root = sqrt(max(b * b - 4.0 * a * c, 0.0));
  float z = clamp(0.25 * (eye_x < 0.0 ? b + root : b - root) / a, 0.0, 1.0);
  return sqrt(1.0 - z) * aside + sqrt(z) * facing;
}
