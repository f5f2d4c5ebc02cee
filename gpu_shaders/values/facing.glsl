// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes Fresnel, Layer Weight and Light Falloff.
#include "programs/shading_point.glsl"

float facing_fresnel(float cosine, float eta)
{
  float c = abs(cosine);
  float g = eta * eta - 1.0 + c * c;
  if (g <= 0.0) {
    return 1.0;
  }
  g = sqrt(g);
  float a = (g - c) / (g + c);
  float b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
  return 0.5 * a * a * (1.0 + b * b);
}

float facing_fresnel_node(ShadingPoint s, vec3 normal, float ior)
{
  float eta = max(ior, 1e-5);
  return facing_fresnel(dot(s.incoming, normal), s.is_back ? 1.0 / eta : eta);
}

float facing_layer_weight(ShadingPoint s, vec3 normal, float blend)
{
  float eta = max(1.0 - blend, 1e-5);
  return facing_fresnel(dot(s.incoming, normal), s.is_back ? eta : 1.0 / eta);
}

float facing_facing(ShadingPoint s, vec3 normal, float blend)
{
  float f = abs(dot(s.incoming, normal));
  if (blend != 0.5) {
    float part = clamp(blend, 0.0, 1.0 - 1e-5);
    float exponent = part < 0.5 ? 2.0 * part : 0.5 / (1.0 - part);
    f = f > 0.0 ? pow(f, exponent) : (exponent == 0.0 ? 1.0 : 0.0);
  }
  return 1.0 - f;
}

// `power`: of the distance that the light's falloff by its square is multiplied with. Far lights have none.
float facing_falloff(ShadingPoint s, float strength, float smoothness, int power)
{
  float square = s.ray_length * s.ray_length;
  if (s.ray_length > 1e18) {
    return strength;
  }
  strength *= power == 0 ? 1.0 : (power == 1 ? s.ray_length : square);
  return smoothness > 0.0 ? strength * square / (smoothness + square) : strength;
}
