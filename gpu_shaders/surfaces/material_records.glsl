// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Records of a material in the sampler `materials` (renderer/surfaces/materials.py): (metallic, roughness, ior,
// specular level); (emission, glossy only); (base color, uses vertex colors); (scale and offset of uv); (image or -1,
// turn of uv).
#include "common/records.glsl"
