// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: 2009-2010 Sony Pictures Imageworks Inc. and contributors (BSD-3-Clause)
// SPDX-FileCopyrightText: 2011-2026 Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Noise Texture, after Cycles (svm/noise.h, fractal_noise.h, noisetex.h). Places have four numbers, of which the first
// `dimensions` count: a constant in every call, so that compilers leave out the rest.
#include "nodes/texture_hash.glsl"

// Perlin's gradient noise

vec4 noise_fade(vec4 t)
{
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

float noise_signed_if(float value, uint condition)
{
  return condition != 0u ? -value : value;
}

float noise_gradient(uint hash, float x)
{
  return noise_signed_if(1.0 + float(hash & 7u), hash & 8u) * x;
}

float noise_gradient(uint hash, vec2 p)
{
  uint h = hash & 7u;
  float u = h < 4u ? p.x : p.y;
  float v = 2.0 * (h < 4u ? p.y : p.x);
  return noise_signed_if(u, h & 1u) + noise_signed_if(v, h & 2u);
}

float noise_gradient(uint hash, vec3 p)
{
  uint h = hash & 15u;
  float u = h < 8u ? p.x : p.y;
  float v = h < 4u ? p.y : (h == 12u || h == 14u ? p.x : p.z);
  return noise_signed_if(u, h & 1u) + noise_signed_if(v, h & 2u);
}

float noise_gradient(uint hash, vec4 p)
{
  uint h = hash & 31u;
  float u = h < 24u ? p.x : p.y;
  float v = h < 16u ? p.y : p.z;
  float w = h < 8u ? p.z : p.w;
  return noise_signed_if(u, h & 1u) + noise_signed_if(v, h & 2u) + noise_signed_if(w, h & 4u);
}

// By one corner of the cell: what is left of the place there.
float noise_corner(ivec2 cell, vec2 place, ivec2 corner)
{
  return noise_gradient(jenkins_hash(uvec2(cell + corner)), place - vec2(corner));
}

float noise_corner(ivec3 cell, vec3 place, ivec3 corner)
{
  return noise_gradient(jenkins_hash(uvec3(cell + corner)), place - vec3(corner));
}

float noise_corner(ivec4 cell, vec4 place, ivec4 corner)
{
  return noise_gradient(jenkins_hash(uvec4(cell + corner)), place - vec4(corner));
}

float noise_perlin(int cell, float place, float fade)
{
  return mix(noise_gradient(jenkins_hash(uint(cell)), place),
             noise_gradient(jenkins_hash(uint(cell + 1)), place - 1.0), fade);
}

float noise_perlin(ivec2 cell, vec2 place, vec2 fade)
{
  return mix(mix(noise_corner(cell, place, ivec2(0, 0)), noise_corner(cell, place, ivec2(1, 0)), fade.x),
             mix(noise_corner(cell, place, ivec2(0, 1)), noise_corner(cell, place, ivec2(1, 1)), fade.x), fade.y);
}

float noise_perlin(ivec3 cell, vec3 place, vec3 fade)
{
  vec4 near = vec4(noise_corner(cell, place, ivec3(0, 0, 0)), noise_corner(cell, place, ivec3(0, 1, 0)),
                   noise_corner(cell, place, ivec3(0, 0, 1)), noise_corner(cell, place, ivec3(0, 1, 1)));
  vec4 far = vec4(noise_corner(cell, place, ivec3(1, 0, 0)), noise_corner(cell, place, ivec3(1, 1, 0)),
                  noise_corner(cell, place, ivec3(1, 0, 1)), noise_corner(cell, place, ivec3(1, 1, 1)));
  vec4 along_x = mix(near, far, fade.x);
  vec2 along_y = mix(along_x.xz, along_x.yw, fade.y);
  return mix(along_y.x, along_y.y, fade.z);
}

vec4 noise_perlin_pairs(ivec4 cell, vec4 place, int x, int w)
{
  return vec4(noise_corner(cell, place, ivec4(x, 0, 0, w)), noise_corner(cell, place, ivec4(x, 1, 0, w)),
              noise_corner(cell, place, ivec4(x, 0, 1, w)), noise_corner(cell, place, ivec4(x, 1, 1, w)));
}

float noise_perlin(ivec4 cell, vec4 place, vec4 fade)
{
  vec4 near = mix(noise_perlin_pairs(cell, place, 0, 0), noise_perlin_pairs(cell, place, 0, 1), fade.w);
  vec4 far = mix(noise_perlin_pairs(cell, place, 1, 0), noise_perlin_pairs(cell, place, 1, 1), fade.w);
  vec4 along_x = mix(near, far, fade.x);
  vec2 along_y = mix(along_x.xz, along_x.yw, fade.y);
  return mix(along_y.x, along_y.y, fade.z);
}

// About -1 to 1. Repeats after 100,000, where single precision ends.
float noise_signed(vec4 p, int dimensions)
{
  vec4 half_step = 0.5 * vec4(greaterThanEqual(abs(p), vec4(1000000.0)));
  p = p - 100000.0 * trunc(p / 100000.0) + half_step;
  vec4 low = floor(p);
  ivec4 cell = ivec4(low);
  vec4 place = p - low;
  vec4 fade = noise_fade(place);
  if (dimensions == 1) {
    return 0.25 * noise_perlin(cell.x, place.x, fade.x);
  }
  if (dimensions == 2) {
    return 0.6616 * noise_perlin(cell.xy, place.xy, fade.xy);
  }
  if (dimensions == 3) {
    return 0.982 * noise_perlin(cell.xyz, place.xyz, fade.xyz);
  }
  return 0.8344 * noise_perlin(cell, place, fade);
}

// Sums of octaves. All take the same arguments; `detail` is from 0 to 15, and its fraction a share of one more octave.

int noise_last_octave(float detail)
{
  return int(detail) + (fract(detail) != 0.0 ? 1 : 0);
}

// Sum of the octaves and of their weights, without the last and with it.
vec4 noise_fbm_sums(vec4 p, int dimensions, float detail, float roughness, float lacunarity)
{
  float scale = 1.0, weight = 1.0;
  vec2 before = vec2(0.0), sums = vec2(0.0);
  int last = noise_last_octave(detail);
  for (int i = 0; i <= last; i++) {
    before = sums;
    sums += vec2(noise_signed(scale * p, dimensions) * weight, weight);
    weight *= roughness;
    scale *= lacunarity;
  }
  return vec4(before, sums);
}

float noise_fbm(vec4 p, int dimensions, float detail, float roughness, float lacunarity, float offset, float gain)
{
  vec4 sums = noise_fbm_sums(p, dimensions, detail, roughness, lacunarity);
  float share = fract(detail);
  return share != 0.0 ? mix(sums.x, sums.z, share) : sums.z;
}

float noise_fbm_normalized(vec4 p, int dimensions, float detail, float roughness, float lacunarity, float offset,
                           float gain)
{
  vec4 sums = noise_fbm_sums(p, dimensions, detail, roughness, lacunarity);
  float share = fract(detail), all = 0.5 * sums.z / sums.w + 0.5;
  return share != 0.0 ? mix(0.5 * sums.x / sums.y + 0.5, all, share) : all;
}

float noise_multifractal(vec4 p, int dimensions, float detail, float roughness, float lacunarity, float offset,
                         float gain)
{
  float value = 1.0, weight = 1.0;
  int whole = int(detail), last = noise_last_octave(detail);
  for (int i = 0; i <= last; i++) {
    float share = i > whole ? fract(detail) : 1.0;
    value *= share * weight * noise_signed(p, dimensions) + 1.0;
    weight *= roughness;
    p *= lacunarity;
  }
  return value;
}

float noise_hetero_terrain(vec4 p, int dimensions, float detail, float roughness, float lacunarity, float offset,
                           float gain)
{
  float value = 1.0, weight = 1.0;
  int whole = int(detail), last = noise_last_octave(detail);
  for (int i = 0; i <= last; i++) {
    float share = i > whole ? fract(detail) : 1.0;
    float increment = (noise_signed(p, dimensions) + offset) * weight * value;
    // (The first octave is what the others are added to.)
    value = i == 0 ? increment : value + share * increment;
    weight *= roughness;
    p *= lacunarity;
  }
  return value;
}

float noise_hybrid_multifractal(vec4 p, int dimensions, float detail, float roughness, float lacunarity, float offset,
                                float gain)
{
  float value = 0.0, power = 1.0, weight = 1.0;
  int whole = int(detail), last = noise_last_octave(detail);
  for (int i = 0; i <= last && weight > 0.001; i++) {
    weight = min(weight, 1.0);
    float share = i > whole ? fract(detail) : 1.0;
    float signal = (noise_signed(p, dimensions) + offset) * power;
    power *= roughness;
    value += share * weight * signal;
    weight *= gain * signal;
    p *= lacunarity;
  }
  return value;
}

float noise_ridged_multifractal(vec4 p, int dimensions, float detail, float roughness, float lacunarity, float offset,
                                float gain)
{
  float value = 0.0, power = 1.0, weight = 1.0;
  int whole = int(detail);
  for (int i = 0; i <= whole; i++) {
    float signal = offset - abs(noise_signed(p, dimensions));
    signal *= signal * weight;
    value += signal * power;
    weight = clamp(signal * gain, 0.0, 1.0);
    power *= roughness;
    p *= lacunarity;
  }
  return value;
}

// The node's other parts

// Seeds stand for places far off, 100 + 100 * hash(seed, axis).
const vec4 NOISE_SEED_0 = vec4(186.03128, 114.955956, 154.44751, 142.50491);
const vec4 NOISE_SEED_1 = vec4(199.84, 162.2926, 154.04823, 142.26761);
const vec4 NOISE_SEED_2 = vec4(111.63384, 157.36938, 199.0881, 178.43613);
const vec4 NOISE_SEED_3 = vec4(165.44528, 162.76822, 193.40842, 145.25551);
const vec4 NOISE_SEED_4 = vec4(155.58092, 177.15463, 138.14003, 180.18573);
const vec4 NOISE_SEED_5 = vec4(188.85379, 132.67769, 162.05215, 185.26816);
// In one dimension 100 + 100 * hash(seed).
const vec4 NOISE_LINE_SEEDS = vec4(158.24258, 114.83605, 188.48869, 0.0);

vec4 noise_distorted(vec4 p, int dimensions, float distortion)
{
  if (dimensions == 1) {
    return p + vec4(noise_signed(p + NOISE_LINE_SEEDS.x, 1) * distortion, 0.0, 0.0, 0.0);
  }
  vec4 shift = vec4(noise_signed(p + NOISE_SEED_0, dimensions), noise_signed(p + NOISE_SEED_1, dimensions), 0.0, 0.0);
  if (dimensions > 2) {
    shift.z = noise_signed(p + NOISE_SEED_2, dimensions);
  }
  if (dimensions > 3) {
    shift.w = noise_signed(p + NOISE_SEED_3, dimensions);
  }
  return p + shift * distortion;
}
