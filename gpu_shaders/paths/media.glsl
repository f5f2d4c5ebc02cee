// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a path is in: up to three media, by numbers of `absorbing` (renderer/tracing/media.py), eight bits each of a
// whole number that a float holds. Media in one another add up, as volumes in Cycles.

int medium_at(int media, int place)
{
  return (media >> (8 * place)) & 255;
}

// After the surface of a medium is crossed: inwards, or outwards. What finds no place is left out.
float crossed(float media, int medium, bool inwards)
{
  int held = int(media + 0.5);
  int changed = held;
  bool done = medium == 0;
  for (int place = 0; place < 3; place++) {
    if (!done && medium_at(held, place) == (inwards ? 0 : medium)) {
      changed = inwards ? held | (medium << (8 * place)) : held & ~(255 << (8 * place));
      done = true;
    }
  }
  return float(changed);
}

// Absorption per meter.
vec3 density_of(float media)
{
  int held = int(media + 0.5);
  vec3 sum = vec3(0.0);
  for (int place = 0; place < 3; place++) {
    sum += fetch_record(absorbing, medium_at(held, place)).rgb;
  }
  return sum;
}

// Of a material, 0 for one that does not absorb.
int medium_of(int material)
{
  return int(fetch_record(absorbing, MEDIA_PLACES + material).x + 0.5);
}
