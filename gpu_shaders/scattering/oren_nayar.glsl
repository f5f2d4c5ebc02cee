// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// A rough diffuse surface, as optics/scattering/oren_nayar.py: Fujii's form of Oren and Nayar's model, and what
// scatters more than once as OpenPBR has it; as Cycles.

struct OrenNayar {
  float level;  // of the even part, per solid angle
  float rough;  // of the part that goes back to where the light comes from
  vec3 again;   // what scatters more than once, over what single scattering leaves over of the light
};

const float ORENNAYAR_PI = 3.14159265358979;

// Part of the albedo that goes with `rough`.
float oren_nayar_share(float cosine)
{
  if (cosine < 1e-6) {
    return 0.5 * ORENNAYAR_PI - 2.0 / 3.0 - cosine;
  }
  float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
  float angle = acos(min(cosine, 1.0));
  return sine * (angle - 2.0 / 3.0 - sine * cosine) + 2.0 / 3.0 * (sine / cosine) * (1.0 - sine * sine * sine);
}

// Of a surface of this color towards one viewer. `even`: share of the surface that is not rough at all.
OrenNayar oren_nayar_of(vec3 color, float roughness, float even, float cos_viewer)
{
  float sigma = clamp(roughness, 0.0, 1.0);
  OrenNayar o;
  o.level = 1.0 / (ORENNAYAR_PI + sigma * (0.5 * ORENNAYAR_PI - 2.0 / 3.0));
  o.rough = sigma * o.level;
  vec3 albedo = clamp(color, 0.0, 1.0);
  float mean = o.level * ORENNAYAR_PI + (2.0 * ORENNAYAR_PI - 5.6) / 3.0 * o.rough;
  float towards = o.level * ORENNAYAR_PI + o.rough * oren_nayar_share(max(cos_viewer, 0.0));
  o.again = albedo * albedo * mean / (ORENNAYAR_PI * max(1.0 - mean, 1e-6)) / (1.0 - albedo * (1.0 - mean));
  o.again *= (1.0 - towards) * (1.0 - even);
  o.level = mix(o.level, 1.0 / ORENNAYAR_PI, even);
  o.rough *= 1.0 - even;
  if (sigma < 1e-5) {
    o.again = vec3(0.0);
  }
  return o;
}

// What goes from the light to the viewer over the surface's color, per solid angle, times the light's cosine.
// `cos_between`: of the angle between both. `roughness`: the surface's own.
vec3 oren_nayar_value(OrenNayar o, float roughness, float cos_viewer, float cos_light, float cos_between)
{
  float l = max(cos_light, 0.0), v = max(cos_viewer, 0.0);
  float back = cos_between - l * v;
  back /= back > 0.0 ? max(max(l, v), 1e-6) : 1.0;
  float sigma = clamp(roughness, 0.0, 1.0);
  float level = 1.0 / (ORENNAYAR_PI + sigma * (0.5 * ORENNAYAR_PI - 2.0 / 3.0));
  float once = level * (ORENNAYAR_PI + sigma * oren_nayar_share(l));
  return l * (vec3(o.level + o.rough * back) + o.again * (1.0 - once));
}

// The albedo in parts of the color: what the surface shows in an evenly lit room.
vec3 oren_nayar_albedo(OrenNayar o, float roughness, float cos_viewer)
{
  float sigma = clamp(roughness, 0.0, 1.0);
  float level = 1.0 / (ORENNAYAR_PI + sigma * (0.5 * ORENNAYAR_PI - 2.0 / 3.0));
  float mean = level * (ORENNAYAR_PI + sigma * (2.0 * ORENNAYAR_PI - 5.6) / 3.0);
  float once = o.level * ORENNAYAR_PI + o.rough * oren_nayar_share(max(cos_viewer, 0.0));
  return vec3(once) + o.again * (ORENNAYAR_PI * (1.0 - mean));
}
