// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far a rough mirror blurs what it shows while the view moves: the ellipse of pixels whose reflected rays end
// where half of this pixel's lobe does. The pixel's ray leaves at O in the direction D and ends after t. One pixel on,
// it ends dO + t dD farther, which is the angle dO / t + dD from here (J, two by two, across D). The lobe of a sharp
// ray is round about the normal and, as a reflected ray turns by twice the normal's turn in the plane of incidence and
// by twice its cosine across, an ellipse about D: its square is S = 4 alpha^2 (cos^2 I + n n'), with n the part of the
// normal across D. In pixels the square is J^-1 S J'^-1; its root needs no axes, so that it changes smoothly.
// `reach`: xx, xy and yy of the root, 0 where no mirror is rough; and one over how far behind the mirror the image of
// what it shows stands, which is 1 / t + 2 c on a mirror of curvature c (as on axis).
#from optics.scattering.microfacet import SHARP_ALPHA
#include "surfaces/material_at.glsl"
#include "surfaces/material_number.glsl"

vec3 reflected_at(ivec2 pixel, vec3 position)
{
  return reflect(normalize(position * view.eye.w - view.eye.xyz), texelFetch(seen_normal, pixel, 0).xyz);
}

// What changes from here to the next pixel along an axis, on the side where it changes less; false at lone pixels.
bool step_along(ivec2 pixel, ivec2 axis, vec4 place, vec3 direction, out vec3 moved, out vec3 turned,
                out float curvature)
{
  ivec2 size = textureSize(seen_position, 0);
  float number = texelFetch(seen_color, pixel, 0).w;
  float least = 1e30;
  moved = turned = vec3(0.0);
  curvature = 0.0;
  vec3 normal = texelFetch(seen_normal, pixel, 0).xyz;
  for (int side = -1; side <= 1; side += 2) {
    ivec2 other = pixel + side * axis;
    if (all(greaterThanEqual(other, ivec2(0))) && all(lessThan(other, size)) &&
        texelFetch(seen_color, other, 0).w == number) {
      vec4 there = texelFetch(seen_position, other, 0);
      vec3 turn = reflected_at(other, there.xyz) - direction;
      if (there.w == place.w && dot(turn, turn) < least) {
        least = dot(turn, turn);
        moved = float(side) * (there.xyz - place.xyz);
        turned = float(side) * turn;
        curvature = dot(texelFetch(seen_normal, other, 0).xyz - normal, moved) * float(side) /
                    max(dot(moved, moved), 1e-30);
      }
    }
  }
  return least < 1e30;
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  reach = vec4(0.0);
  float number = texelFetch(seen_color, pixel, 0).w;
  if (number < 0.5) {
    return;
  }
  vec4 place = texelFetch(seen_position, pixel, 0);
  vec4 facing = texelFetch(seen_normal, pixel, 0);
  float roughness = material_at(pixel, material_number(facing.w), vec3(0.0)).roughness;
  float alpha = roughness * roughness;
  if (alpha < SHARP_ALPHA) {
    return;
  }
  vec3 direction = reflected_at(pixel, place.xyz);
  vec3 moved_x, turned_x, moved_y, turned_y;
  float curved_x, curved_y;
  if (!step_along(pixel, ivec2(1, 0), place, direction, moved_x, turned_x, curved_x) ||
      !step_along(pixel, ivec2(0, 1), place, direction, moved_y, turned_y, curved_y)) {
    return;
  }
  vec4 hit = texelFetch(path_position, pixel, 0);
  float nearness = hit.w > 0.0 ? 1.0 / max(distance(hit.xyz, place.xyz), 1e-20) : 0.0;
  vec3 step_x = turned_x + nearness * moved_x;
  vec3 step_y = turned_y + nearness * moved_y;
  // Any two axes across the direction.
  vec3 first = normalize(abs(direction.z) < 0.7 ? cross(direction, vec3(0.0, 0.0, 1.0))
                                                : cross(direction, vec3(1.0, 0.0, 0.0)));
  vec3 second = cross(direction, first);
  vec2 column_x = vec2(dot(first, step_x), dot(second, step_x));
  vec2 column_y = vec2(dot(first, step_y), dot(second, step_y));
  vec2 across = vec2(dot(first, facing.xyz), dot(second, facing.xyz));
  float cosine2 = max(1.0 - dot(across, across), LEAST_COSINE * LEAST_COSINE);
  // J^-1 S J'^-1, with J^-1 by its adjugate.
  float determinant = column_x.x * column_y.y - column_y.x * column_x.y;
  vec2 row_x = vec2(column_y.y, -column_y.x);
  vec2 row_y = vec2(-column_x.y, column_x.x);
  float width = WIDTH + WIDER * alpha;
  float scale = 4.0 * alpha * alpha * width * width / max(determinant * determinant, 1e-30);
  float n_x = dot(row_x, across), n_y = dot(row_y, across);
  float xx = scale * (cosine2 * dot(row_x, row_x) + n_x * n_x);
  float xy = scale * (cosine2 * dot(row_x, row_y) + n_x * n_y);
  float yy = scale * (cosine2 * dot(row_y, row_y) + n_y * n_y);
  // Its root, no longer than the picture allows.
  float middle = 0.5 * (xx + yy);
  float half_gap = sqrt(max(0.25 * (xx - yy) * (xx - yy) + xy * xy, 0.0));
  float most = LARGEST_REACH * float(textureSize(seen_position, 0).y);
  float longer = min(sqrt(middle + half_gap), most);
  float shorter = min(sqrt(max(middle - half_gap, 0.0)), most);
  // (Of the longer axis, twice: cosine and sine of twice its angle.)
  vec2 twice = half_gap > 0.0 ? vec2(0.5 * (xx - yy), xy) / half_gap : vec2(0.0);
  float mean = 0.5 * (longer + shorter), gap = 0.5 * (longer - shorter);
  reach = vec4(mean + gap * twice.x, gap * twice.y, mean - gap * twice.x, nearness + curved_x + curved_y);
}
