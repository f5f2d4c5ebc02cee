// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors in the map frame; mirrors parts of optics/fermat.py and optics/screen.py. The eye is homogeneous: w = 0 is
// at infinity.

vec3 safe_unit(vec3 v)
{
  float length_squared = dot(v, v);
  return length_squared > 0.0 ? v * inversesqrt(length_squared) : vec3(0.0);
}

bool is_finite(vec3 v)
{
  return !any(isnan(v)) && all(lessThan(abs(v), vec3(LARGEST_COORDINATE)));
}

vec3 towards_eye(vec4 eye, vec3 point)
{
  return safe_unit(eye.xyz - point * eye.w);
}

// Pixels that an offset at a point covers as seen from the eye, as two-dimensional as a 3D vector can be.
vec3 in_pixels(vec4 eye, float focal, vec3 point, vec3 offset)
{
  vec3 direction = towards_eye(eye, point);
  float distance_to_eye = eye.w > 0.0 ? max(length(eye.xyz - point), 1e-30) : 1.0;
  return (offset - dot(offset, direction) * direction) * (focal / distance_to_eye);
}

// Two unit vectors that complete u to a right-handed frame.
void tangent_frame(vec3 u, out vec3 first, out vec3 second)
{
  vec3 helper = abs(u.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  first = safe_unit(cross(u, helper));
  second = cross(u, first);
}
