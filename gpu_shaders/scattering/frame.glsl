// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
const float PI = 3.14159265358979;

// Right-handed, x towards the tangent where it is not along the normal.
mat3 surface_frame(vec3 normal, vec3 tangent)
{
  vec3 y = cross(normal, tangent);
  float square = dot(y, y);
  if (!(square > 1e-8)) {
    // Duff et al., "Building an Orthonormal Basis, Revisited" (2017).
    float side = normal.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (side + normal.z);
    y = vec3(normal.x * normal.y * a, side + normal.y * normal.y * a, -normal.y);
    square = 1.0;
  }
  y *= inversesqrt(square);
  return mat3(cross(y, normal), y, normal);
}
