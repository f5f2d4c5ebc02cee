// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface is made of at a pixel: constants of its material, and what its program has left in buffers (of those
// that the scene's programs fill: PROGRAM_SCALARS, PROGRAM_SHINE, PROGRAM_LAYERS; renderer/programs/buffers.py).
#include "surfaces/material_records.glsl"
#include "programs/material.glsl"

// With what `kind` says.
Material settled(Material m)
{
  int bits = int(m.kind + 0.5);
  m.glossy_only = (bits & KIND_GLOSSY_ONLY) != 0;
  m.thin_wall = (bits & KIND_THIN_WALL) != 0;
  m.glass = (bits & KIND_REFRACTION) != 0 ? GLASS_REFRACTION :
            ((bits & KIND_GLASS) != 0 ? GLASS_GLASS : GLASS_PRINCIPLED);
  return m;
}

Material material_constants(int index)
{
  int record = MATERIAL_RECORDS * max(index, 0);
  vec4 first = fetch_record(materials, record);
  vec4 emission = fetch_record(materials, record + 1);
  vec4 coat = fetch_record(materials, record + 3);
  vec4 coat_tint = fetch_record(materials, record + 4);
  vec4 specular_tint = fetch_record(materials, record + 5);
  vec4 transparent = fetch_record(materials, record + 7);
  vec4 rest = fetch_record(materials, record + 8);
  vec4 sheen = fetch_record(materials, record + 9);
  vec4 last = fetch_record(materials, record + 10);
  Material m;
  m.base_color = fetch_record(materials, record + 2).rgb;
  m.metallic = first.x;
  m.roughness = first.y;
  m.ior = first.z;
  m.specular_level = first.w;
  m.specular_tint = specular_tint.rgb;
  m.emission = emission.rgb;
  m.normal = vec3(0.0, 0.0, 1.0);
  m.transmission = coat.w;
  m.alpha = transparent.w;
  m.transparent_tint = transparent.rgb;
  m.coat_weight = coat.x;
  m.coat_roughness = coat.y;
  m.coat_ior = coat.z;
  m.coat_tint = coat_tint.rgb;
  m.sheen_weight = sheen.w;
  m.sheen_roughness = last.x;
  m.sheen_tint = sheen.rgb;
  m.film_thickness = coat_tint.w;
  m.film_ior = specular_tint.w;
  m.anisotropy = rest.x;
  m.anisotropic_rotation = rest.y;
  m.diffuse_roughness = rest.z;
  m.subsurface = last.y;
  m.translucency = rest.w;
  m.kind = emission.w;
  m.absorption = fetch_record(materials, record + 6).rgb;
#ifdef LIGHTING_LINKED
  m.light_set = int(emission.w + 0.5) >> LIGHT_SET_SHIFT;
  m.shines_on = int(last.w + 0.5) >> SHINES_ON_SHIFT;
#endif
  return m;
}

#if defined(PROGRAM_SCALARS) || defined(PROGRAM_SHINE) || defined(PROGRAM_LAYERS)
int varies(int index)
{
  return int(fetch_record(materials, MATERIAL_RECORDS * max(index, 0) + 10).w + 0.5);
}
#endif

#ifdef PROGRAM_SCALARS
vec4 packed_scalars(Material m)
{
  return vec4(m.roughness, m.metallic, m.transmission, m.alpha);
}

void unpack_scalars(int index, vec4 scalars, inout Material m)
{
  if ((varies(index) & VARIES_SCALARS) != 0) {
    m.roughness = scalars.x;
    m.metallic = scalars.y;
    m.transmission = scalars.z;
    m.alpha = scalars.w;
  }
}
#endif

#ifdef PROGRAM_SHINE
vec4 packed_shine(Material m)
{
  // (Half precision ends a little above.)
  return vec4(clamp(m.emission, vec3(-6e4), vec3(6e4)), m.specular_level);
}

void unpack_shine(int index, vec4 shine, inout Material m)
{
  if ((varies(index) & VARIES_SHINE) != 0) {
    m.emission = shine.rgb;
    m.specular_level = shine.w;
  }
}
#endif

#ifdef PROGRAM_LAYERS
uint packed_unit(float value, int bits)
{
  float most = float((1 << bits) - 1);
  return uint(clamp(value, 0.0, 1.0) * most + 0.5);
}

float unpacked_unit(uint held, int shift, int bits)
{
  uint most = (1u << uint(bits)) - 1u;
  return float((held >> uint(shift)) & most) / float(most);
}

// Six bits a channel, of the square root: eyes tell dark tints apart.
uint packed_tint(vec3 tint)
{
  vec3 root = sqrt(clamp(tint, vec3(0.0), vec3(1.0)));
  return packed_unit(root.r, 6) | (packed_unit(root.g, 6) << 6u) | (packed_unit(root.b, 6) << 12u);
}

vec3 unpacked_tint(uint held)
{
  vec3 root = vec3(unpacked_unit(held, 0, 6), unpacked_unit(held, 6, 6), unpacked_unit(held, 12, 6));
  return root * root;
}

uvec4 packed_layers(Material m)
{
  uvec4 held;
  held.x = packed_tint(m.coat_tint) | (packed_unit(m.coat_weight, 6) << 18u) |
           (packed_unit(m.coat_roughness, 8) << 24u);
  held.y = packed_tint(m.sheen_tint) | (packed_unit(m.sheen_weight, 6) << 18u) |
           (packed_unit(m.sheen_roughness, 8) << 24u);
  held.z = packed_tint(m.specular_tint) | (packed_unit(m.diffuse_roughness, 6) << 18u) |
           ((uint(m.kind + 0.5) & 15u) << 24u) | (packed_unit(m.translucency, 4) << 28u);
  held.w = (packHalf2x16(vec2(m.ior, 0.0)) & 0xffffu) | (packed_unit(0.5 + 0.5 * m.anisotropy, 8) << 16u) |
           (packed_unit(fract(m.anisotropic_rotation), 8) << 24u);
  return held;
}

void unpack_layers(int index, uvec4 held, inout Material m)
{
  if ((varies(index) & VARIES_LAYERS) != 0) {
    m.coat_tint = unpacked_tint(held.x);
    m.coat_weight = unpacked_unit(held.x, 18, 6);
    m.coat_roughness = unpacked_unit(held.x, 24, 8);
    m.sheen_tint = unpacked_tint(held.y);
    m.sheen_weight = unpacked_unit(held.y, 18, 6);
    m.sheen_roughness = unpacked_unit(held.y, 24, 8);
    m.specular_tint = unpacked_tint(held.z);
    m.diffuse_roughness = unpacked_unit(held.z, 18, 6);
    m.kind = float((held.z >> 24u) & 15u);
    m.translucency = unpacked_unit(held.z, 28, 4);
    m.ior = unpackHalf2x16(held.w & 0xffffu).x;
    m.anisotropy = 2.0 * unpacked_unit(held.w, 16, 8) - 1.0;
    m.anisotropic_rotation = unpacked_unit(held.w, 24, 8);
  }
}
#endif

#ifndef FILLS_BUFFERS
// At a pixel of the buffers `surface_scalars`, `surface_shine` and `surface_layers`.
Material material_at(ivec2 pixel, int index, vec3 color)
{
  Material m = material_constants(index);
  m.base_color = color;
#ifdef PROGRAM_SCALARS
  unpack_scalars(index, texelFetch(surface_scalars, pixel, 0), m);
#endif
#ifdef PROGRAM_SHINE
  unpack_shine(index, texelFetch(surface_shine, pixel, 0), m);
#endif
#ifdef PROGRAM_LAYERS
  unpack_layers(index, texelFetch(surface_layers, pixel, 0), m);
#endif
  return settled(m);
}
#endif
