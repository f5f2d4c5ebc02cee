// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is tabulated of the GGX lobe, in the sampler (FLOAT_2D) `lighting_ggx` of renderer/lighting/ggx.py.
// Multiple scattering: Kulla and Conty, "Revisiting Physically Based Shading at Imageworks" (2017), the single
// lobe scaled by its missing energy as Turquin, "Practical multiple scattering compensation" (2019).

// Below this squared roughness squared a lobe is a mirror, which no lamp sample can hit.
#from optics.scattering.microfacet import SHARP_ALPHA as GGX_SINGULAR_ALPHA

const float LIGHTING_PI = 3.14159265358979;

vec4 ggx_entry(float roughness, float cosine, float slice, float first_row)
{
  vec2 place = clamp(vec2(cosine, roughness), 0.0, 1.0) * float(GGX_TABLE_SIZE - 1) + 0.5;
  vec2 size = vec2(float(GGX_TABLE_SIZE * (GGX_IOR_SLICES + 1)), float(4 * GGX_TABLE_SIZE));
  return textureLod(lighting_ggx, (place + vec2(slice * float(GGX_TABLE_SIZE), first_row)) / size, 0.0);
}

// x: albedo of the lobe with Fresnel 1; y: mean over it of Schlick's (1 - cos)^5; z, w: mean share of a dielectric's
// Fresnel term between F0 and 1, of this slice's IOR and the next's; w of the last slice: mean of cos (1 - cos)^6. In
// the slice after the last, x: cosine between the lobe's mean direction and the normal, y: roughness of the lobe that
// is spread as much about its own normal; z, w: of a dielectric.
vec4 ggx_table(float roughness, float cosine, float slice)
{
  return ggx_entry(roughness, cosine, slice, 0.0);
}

// Of an interface that lets light through, below the others; two steps of IOR to a slice. x, y: albedo at either, seen
// from outside; z, w: from inside. In the last slice, with the step's place 0 .. 1 for the cosine, x, z: the
// cosine-weighted average over all angles from outside and inside.
vec4 ggx_glass_table(float roughness, float cosine, float slice)
{
  return ggx_entry(roughness, cosine, slice, float(GGX_TABLE_SIZE));
}

// Of sheen, in the last quarter: both numbers of the transform (scattering/sheen.glsl), and the albedo.
vec3 sheen_table(float roughness, float cosine)
{
  return ggx_entry(roughness, cosine, 0.0, float(3 * GGX_TABLE_SIZE)).xyz;
}

// Cosine-weighted average of the lobe's albedo over all angles (fitted to the table, error under 0.007).
float average_albedo(float roughness)
{
  return 1.0 - roughness * roughness * (-0.26747 + roughness * (2.1086 - 1.25199 * roughness));
}

// 1 + what scatters more than once, in parts of the single scattering. `fresnel`: mean over angles; `missing`: share
// of the albedo that single scattering loses, over that it keeps.
vec3 multiple_scattering(vec3 fresnel, float average, float missing)
{
  return 1.0 + fresnel * average / (1.0 - fresnel * (1.0 - average)) * missing;
}
