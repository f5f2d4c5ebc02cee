// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light linking: objects are in sets, and lamps and what shines know bits of those that their light gets to. Rays take
// the set of what they have left along, as their `position` w, beside the number of the object that they met, or where
// they met nothing as their `normal` w.
#ifdef LIGHTING_LINKED
#from renderer.surfaces.light_sets import LIGHT_SET_SHIFT, SHINES_ON_SHIFT, SET_STEPS

// Of what the ray of `lamps_seen` has left; below 0: it sees all lamps, as the camera does.
int lamps_met_from = -1;

bool is_for_set(int sets, int number)
{
  return ((sets >> number) & 1) != 0;
}

float with_set(float object_id, int number)
{
  return object_id + float(number) / SET_STEPS;
}

// Of what a ray has left, which is this here.
int set_on_way(vec4 position, vec4 normal)
{
  return position.w > 0.5 ? int(fract(position.w) * SET_STEPS + 0.5) : int(normal.w + 0.5);
}
#endif
