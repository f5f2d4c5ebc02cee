// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Colors as hue, saturation and value or lightness, as Blender's nodes have them.

vec3 color_to_hsv(vec3 rgb)
{
  float high = max(rgb.x, max(rgb.y, rgb.z));
  float span = high - min(rgb.x, min(rgb.y, rgb.z));
  float saturation = high != 0.0 ? span / high : 0.0;
  if (saturation == 0.0) {
    return vec3(0.0, saturation, high);
  }
  vec3 c = (vec3(high) - rgb) / span;
  float hue = rgb.x == high ? c.z - c.y : (rgb.y == high ? 2.0 + c.x - c.z : 4.0 + c.y - c.x);
  hue /= 6.0;
  return vec3(hue < 0.0 ? hue + 1.0 : hue, saturation, high);
}

vec3 color_from_hsv(vec3 hsv)
{
  float v = hsv.z;
  if (hsv.y == 0.0) {
    return vec3(v);
  }
  float hue = hsv.x == 1.0 ? 0.0 : hsv.x * 6.0;
  float sextant = floor(hue);
  float part = hue - sextant;
  float p = v * (1.0 - hsv.y);
  float q = v * (1.0 - hsv.y * part);
  float t = v * (1.0 - hsv.y * (1.0 - part));
  if (sextant == 0.0) {
    return vec3(v, t, p);
  }
  if (sextant == 1.0) {
    return vec3(q, v, p);
  }
  if (sextant == 2.0) {
    return vec3(p, v, t);
  }
  if (sextant == 3.0) {
    return vec3(p, q, v);
  }
  if (sextant == 4.0) {
    return vec3(t, p, v);
  }
  return vec3(v, p, q);
}

vec3 color_to_hsl(vec3 rgb)
{
  float high = max(rgb.x, max(rgb.y, rgb.z));
  float low = min(rgb.x, min(rgb.y, rgb.z));
  float span = high - low;
  float lightness = min(1.0, (high + low) / 2.0);
  if (span == 0.0) {
    return vec3(0.0, 0.0, lightness);
  }
  float saturation = lightness > 0.5 ? span / (2.0 - high - low) : span / (high + low);
  float hue;
  if (high == rgb.x) {
    hue = (rgb.y - rgb.z) / span + (rgb.y < rgb.z ? 6.0 : 0.0);
  }
  else {
    hue = high == rgb.y ? (rgb.z - rgb.x) / span + 2.0 : (rgb.x - rgb.y) / span + 4.0;
  }
  return vec3(hue / 6.0, saturation, lightness);
}

vec3 color_from_hsl(vec3 hsl)
{
  float hue = hsl.x * 6.0;
  vec3 pure = vec3(abs(hue - 3.0) - 1.0, 2.0 - abs(hue - 2.0), 2.0 - abs(hue - 4.0));
  float chroma = (1.0 - abs(2.0 * hsl.z - 1.0)) * hsl.y;
  return (clamp(pure, 0.0, 1.0) - 0.5) * chroma + hsl.z;
}
