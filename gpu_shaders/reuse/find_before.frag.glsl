// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where an earlier frame has shown the scene point that this pixel shows. Where that point was then, V, is known by
// its object's motion, and the earlier frame has kept the point X(y) that each pixel y showed: so y is where X(y) = V.
// It is found by Gauss and Newton's steps, with differences of neighbors as derivatives, from the best of some places
// about where the mirror's own point was; exact but for what X bends within a pixel. It counts only where X really
// gets as near to V as a pixel is wide: another thing before it, a thing that was elsewhere, and another image on the
// mirror are told by that distance, and begin anew.
#include "common/records.glsl"
#include "reuse/earlier_frame.glsl"

vec3 wanted;

// How X changes from a pixel to the next along an axis; by the side where it changes less, as an edge of another part
// of the object may lie on the other.
bool slope(ivec2 place, ivec2 axis, out vec3 change)
{
  vec3 here = point_at(place);
  float least = 1e30;
  change = vec3(0.0);
  for (int side = -1; side <= 1; side += 2) {
    ivec2 other = place + side * axis;
    if (fits(other)) {
      vec3 way = float(side) * (point_at(other) - here);
      if (dot(way, way) < least) {
        least = dot(way, way);
        change = way;
      }
    }
  }
  return least < 1e30;
}

// `w` is 0 of a direction.
vec2 on_picture(vec3 point, float w)
{
  vec4 clip = then_to_clip * vec4(point, w);
  return clip.w > 0.0 ? (0.5 * clip.xy / clip.w + 0.5) * vec2(textureSize(then_shown, 0)) : vec2(-1e4);
}

vec3 moved(vec3 point, int number)
{
  vec4 whole = vec4(point, 1.0);
  return vec3(dot(fetch_record(motions, MOTION_RECORDS * number), whole),
              dot(fetch_record(motions, MOTION_RECORDS * number + 1), whole),
              dot(fetch_record(motions, MOTION_RECORDS * number + 2), whole));
}

// The fitting pixel whose point is nearest, of the first `count` of the place itself and rings around it.
bool nearest(vec2 start, int count, out ivec2 found)
{
  float least = 1e38;
  found = ivec2(floor(start));
  for (int k = 0; k < count; k++) {
    float radius = k == 0 ? 0.0 : exp2(float((k - 1) / 8));
    float turn = 0.7853982 * (float(k) + 0.5 * float((k - 1) / 8));
    ivec2 place = ivec2(floor(start + radius * vec2(cos(turn), sin(turn))));
    if (fits(place)) {
      vec3 way = point_at(place) - wanted;
      if (dot(way, way) < least) {
        least = dot(way, way);
        found = place;
      }
    }
  }
  return least < 1e38;
}

// The square of the area that a pixel shows here now, as `slope` has it; 0 where that is not known.
float area_now(ivec2 pixel)
{
  vec3 sides[2] = vec3[2](vec3(0.0), vec3(0.0));
  vec4 here = texelFetch(now_shown, pixel, 0);
  float own = texelFetch(now_tint, pixel, 0).w;
  ivec2 last = textureSize(now_shown, 0) - 1;
  for (int axis = 0; axis < 2; axis++) {
    float least = 1e30;
    for (int side = -1; side <= 1; side += 2) {
      ivec2 other = clamp(pixel + side * ivec2(1 - axis, axis), ivec2(0), last);
      vec4 there = texelFetch(now_shown, other, 0);
      vec3 way = there.xyz - here.xyz;
      if (other != pixel && there.w == here.w && texelFetch(now_tint, other, 0).w == own && dot(way, way) < least) {
        least = dot(way, way);
        sides[axis] = way;
      }
    }
  }
  vec3 across = cross(sides[0], sides[1]);
  return dot(across, across);
}

// Where X is the wanted point, in pixels of the earlier frame; false where it is nowhere near.
bool solved(ivec2 place, float area, out vec2 at)
{
  for (int k = 0; k < STEPS; k++) {
    vec3 along_x, along_y;
    if (!slope(place, ivec2(1, 0), along_x) || !slope(place, ivec2(0, 1), along_y)) {
      return false;
    }
    vec3 way = wanted - point_at(place);
    float xx = dot(along_x, along_x), xy = dot(along_x, along_y), yy = dot(along_y, along_y);
    float determinant = xx * yy - xy * xy;
    if (determinant <= 1e-8 * xx * yy) {
      return false;
    }
    vec2 right = vec2(dot(along_x, way), dot(along_y, way));
    vec2 by = vec2(yy * right.x - xy * right.y, xx * right.y - xy * right.x) / determinant;
    float length_of = max(abs(by.x), abs(by.y));
    if (length_of <= NEAR) {
      // (What is left lies across the surface that X goes along.)
      vec3 rest = way - along_x * by.x - along_y * by.y;
      at = vec2(place) + 0.5 + by;
      // (A pixel that showed much more than this one does would only blur it.)
      bool is_fine = area == 0.0 || determinant <= COARSEST * COARSEST * area;
      return is_fine && dot(rest, rest) <= FAR * FAR * max(xx, yy) && fits(ivec2(floor(at)));
    }
    vec2 step_by = by * min(1.0, LONGEST / length_of);
    ivec2 next = ivec2(floor(vec2(place) + 0.5 + step_by));
    for (int tries = 0; tries < 3 && !fits(next); tries++) {
      step_by *= 0.5;
      next = ivec2(floor(vec2(place) + 0.5 + step_by));
    }
    if (next == place || !fits(next)) {
      return false;
    }
    place = next;
  }
  return false;
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  found_at = vec4(0.0);
  vec4 shown = texelFetch(now_shown, pixel, 0);
  float mirror = texelFetch(now_tint, pixel, 0).w;
  if (mirror == SERVES_NONE) {
    return;
  }
  int number = int(shown.w);
  wanted = shown.xyz;
  wanted_code = shown.w - float(number);
  if (number > 0) {
    vec4 known = fetch_record(motions, MOTION_RECORDS * number + 3);
    if (known.x < 0.5) {
      return;
    }
    wanted = moved(wanted, number);
    wanted_code += known.y;
  }
  vec2 at;
  vec3 start = wanted;
  bool shows_several = mirror <= SHOWS_SEVERAL;
  int own_number = int((shows_several ? SHOWS_SEVERAL - mirror : mirror) + 0.5);
  float number_then = own_number == 0 ? 0.0 : fetch_record(mirror_numbers, own_number).x;
  if (own_number > 0 && number_then < 0.5) {
    return;
  }
  wanted_mirror = shows_several ? SHOWS_SEVERAL - number_then : number_then;
  if (mirror > 0.5) {
    vec4 own = texelFetch(seen_position, pixel, 0);
    start = moved(own.xyz, int(own.w));
  }
  bool is_point = number > 0 || mirror > 0.5;
  vec2 begun = on_picture(start, is_point ? 1.0 : 0.0);
  float area = area_now(pixel);
  // (Most are found at once. Software drivers leave out what a loop does not come to, but no branch.)
  bool is_found = false;
  for (int count = 1; count <= 1 + 8 * RINGS && !is_found; count += 8 * RINGS) {
    ivec2 place;
    if (nearest(begun, count, place)) {
      is_found = solved(place, area, at);
    }
  }
  if (is_found) {
    found_at = vec4(at, 1.0, 0.0);
  }
}
