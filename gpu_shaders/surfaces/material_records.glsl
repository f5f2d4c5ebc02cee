// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Records of a material in the sampler `materials` (renderer/surfaces/materials.py): (metallic, roughness, ior,
// specular level); (emission, glossy only); (base color, uses vertex colors); (scale and offset of uv); (image or -1,
// turn of uv). Of paths alone: (coat weight, coat roughness, coat ior, transmission); (coat tint, glass); (specular
// tint, film thickness); (absorption, film ior); (transparent tint, alpha); (alpha threshold, anisotropy, its
// rotation, flags); (scale and offset of the scalars' uv); (scalars' image or -1, turn of their uv, whether it is seen
// through).
#include "common/records.glsl"
