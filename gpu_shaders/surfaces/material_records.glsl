// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Records of a material in the sampler `materials` (renderer/surfaces/materials.py): (metallic, roughness, ior,
// specular level); (emission, kind); (base color, number of its program or -1); (coat weight, coat roughness, coat
// ior, transmission); (coat tint, film thickness); (specular tint, film ior); (absorption, whether it is seen
// through); (transparent tint, alpha); (anisotropy, its rotation, diffuse roughness, translucency); (sheen tint,
// sheen weight); (sheen roughness, subsurface, first of its program's parameters, which buffers its program fills:
// VARIES_ bits). In scenes with light linking the material's light set is above its kind, and the sets that it shines
// on are above those bits.
#include "common/records.glsl"
#include "surfaces/light_sets.glsl"
#from renderer.programs.buffers import VARIES_SCALARS, VARIES_SHINE, VARIES_LAYERS
#ifdef LIGHTING_LINKED

int light_set_of(int material)
{
  return int(fetch_record(materials, MATERIAL_RECORDS * max(material, 0) + 1).w + 0.5) >> LIGHT_SET_SHIFT;
}
#endif
