// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Records of a material in the sampler `materials` (renderer/surfaces/materials.py): (metallic, roughness, ior,
// specular level); (emission, kind); (base color, number of its program or -1); (coat weight, coat roughness, coat
// ior, transmission); (coat tint, film thickness); (specular tint, film ior); (absorption, whether it is seen
// through); (transparent tint, alpha); (anisotropy, its rotation, diffuse roughness, translucency); (sheen tint,
// sheen weight); (sheen roughness, subsurface, first of its program's parameters, which buffers its program fills:
// VARIES_ bits).
#include "common/records.glsl"
#from renderer.programs.buffers import VARIES_SCALARS, VARIES_SHINE, VARIES_LAYERS
