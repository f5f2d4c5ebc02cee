// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: 2011-2026 Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Hashes of lattices, after Cycles (util/hash.h): Jenkins' lookup3 and PCG ("Hash Functions for GPU Rendering", 2020).

uint jenkins_turned(uint x, int bits)
{
  return (x << bits) | (x >> (32 - bits));
}

uint jenkins_final(uint a, uint b, uint c)
{
  c = (c ^ b) - jenkins_turned(b, 14);
  a = (a ^ c) - jenkins_turned(c, 11);
  b = (b ^ a) - jenkins_turned(a, 25);
  c = (c ^ b) - jenkins_turned(b, 16);
  a = (a ^ c) - jenkins_turned(c, 4);
  b = (b ^ a) - jenkins_turned(a, 14);
  return (c ^ b) - jenkins_turned(b, 24);
}

// Where the three words start, by how many numbers are hashed.
#define JENKINS_START(count) (0xdeadbeefu + uint((count) << 2) + 13u)

uint jenkins_hash(uint key)
{
  uint start = JENKINS_START(1);
  return jenkins_final(start + key, start, start);
}

uint jenkins_hash(uvec2 key)
{
  uint start = JENKINS_START(2);
  return jenkins_final(start + key.x, start + key.y, start);
}

uint jenkins_hash(uvec3 key)
{
  uvec3 word = JENKINS_START(3) + key;
  return jenkins_final(word.x, word.y, word.z);
}

uint jenkins_hash(uvec4 key)
{
  uvec3 word = JENKINS_START(4) + key.xyz;
  uint a = word.x, b = word.y, c = word.z;
  a = (a - c) ^ jenkins_turned(c, 4);
  c += b;
  b = (b - a) ^ jenkins_turned(a, 6);
  a += c;
  c = (c - b) ^ jenkins_turned(b, 8);
  b += a;
  a = (a - c) ^ jenkins_turned(c, 16);
  c += b;
  b = (b - a) ^ jenkins_turned(a, 19);
  a += c;
  c = (c - b) ^ jenkins_turned(b, 4);
  b += a;
  return jenkins_final(a + key.w, b, c);
}

// From 0 to 1, by the bits of floats.
float hash_unit(float key)
{
  return float(jenkins_hash(floatBitsToUint(key))) * (1.0 / 4294967295.0);
}

float hash_unit(vec2 key)
{
  return float(jenkins_hash(floatBitsToUint(key))) * (1.0 / 4294967295.0);
}

float hash_unit(vec3 key)
{
  return float(jenkins_hash(floatBitsToUint(key))) * (1.0 / 4294967295.0);
}

float hash_unit(vec4 key)
{
  return float(jenkins_hash(floatBitsToUint(key))) * (1.0 / 4294967295.0);
}

vec3 hash_color(float key)
{
  return vec3(hash_unit(key), hash_unit(vec2(key, 1.0)), hash_unit(vec2(key, 2.0)));
}

vec3 hash_color(vec2 key)
{
  return vec3(hash_unit(key), hash_unit(vec3(key, 1.0)), hash_unit(vec3(key, 2.0)));
}

vec3 hash_color(vec3 key)
{
  return vec3(hash_unit(key), hash_unit(vec4(key, 1.0)), hash_unit(vec4(key, 2.0)));
}

vec3 hash_color(vec4 key)
{
  return vec3(hash_unit(key), hash_unit(key.zxwy), hash_unit(key.wzyx));
}

// From 0 to 1, by cells of a lattice. (Shifts of negative numbers keep the sign, as in Cycles.)
vec2 pcg_unit(ivec2 v)
{
  v = v * 1664525 + 1013904223;
  v.x += v.y * 1664525;
  v.y += v.x * 1664525;
  v ^= v >> 16;
  v.x += v.y * 1664525;
  v.y += v.x * 1664525;
  return vec2(v & 0x7FFFFFFF) * (1.0 / 2147483647.0);
}

vec3 pcg_unit(ivec3 v)
{
  v = v * 1664525 + 1013904223;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return vec3(v & 0x7FFFFFFF) * (1.0 / 2147483647.0);
}

vec4 pcg_unit(ivec4 v)
{
  v = v * 1664525 + 1013904223;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return vec4(v & 0x7FFFFFFF) * (1.0 / 2147483647.0);
}
