// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// An infinitely far environment for surface inspection: bands of the angle to an axis, or with LAMPS long lamps along
// it. `stripe_axis` is the axis; `stripe_up` and `stripe_side`, in the other case, are across it. It is looked up by
// the reflected ray, or with OF_NORMALS by the normal: isophotes and highlight lines, which stay while the eye moves.
// With FRAMES_BY_MIRROR each mirror has axes of its own: three records each of `stripe_frames`, by its number.
#include "diagnostics/diagnostic_mirror.glsl"
#ifdef FRAMES_BY_MIRROR
#include "common/records.glsl"
#endif

#define PI 3.14159265358979

// Share of [x - width / 2, x + width / 2] in which the fraction of x is below `duty`: a pulse train, box-filtered.
float pulses(float x, float duty, float width)
{
  float low = x - 0.5 * width;
  float high = x + 0.5 * width;
  float filled = (floor(high) * duty + min(fract(high), duty)) - (floor(low) * duty + min(fract(low), duty));
  return clamp(filled / width, 0.0, 1.0);
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  MirrorPixel at = mirror_pixel(pixel);
#ifdef OF_NORMALS
  vec3 looked_up = at.normal;
#else
  vec3 looked_up = at.ray;
#endif
#ifdef FRAMES_BY_MIRROR
  int first = 3 * max(int(at.number + 0.5), 0);
  vec3 stripe_axis = fetch_record(stripe_frames, first).xyz;
  vec3 stripe_up = fetch_record(stripe_frames, first + 1).xyz;
  vec3 stripe_side = fetch_record(stripe_frames, first + 2).xyz;
#endif
#ifdef LAMPS
  vec2 across = vec2(dot(looked_up, stripe_up), dot(looked_up, stripe_side));
  float turn = atan(across.y, across.x) / (2.0 * PI);
  // Derivatives of the ray, not of the angle, which jumps where a turn is full.
  float width = length(fwidth(across)) / max(length(across), 1e-4) / (2.0 * PI) * count;
  float x = turn * count + 0.5 * duty;
#else
  float along = dot(looked_up, stripe_axis);
  float x = acos(clamp(along, -1.0, 1.0)) / PI * count;
  float width = fwidth(x);
#endif
  // At the mirror's rim the neighbor's ray is another surface's.
  if (fwidth(at.number) > 0.0) {
    width = 0.0;
  }
  float white = pulses(x, duty, max(max(width, softness), 1e-3));
  color = opacity * premultiplied(mix(dark, bright, white), at);
}
