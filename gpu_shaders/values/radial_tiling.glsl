// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: 2024-2025 Blender Authors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// The node Radial Tiling: segments of a polygon with rounded corners, the last one smaller where the number of sides
// is no whole one. Angles go from the divider between two segments. Of a corner: `start` is where its arc ends, `lean`
// the angle from there to the middle of the side, `spline` and `rounded` are lengths of the arc's two parts.
#include "values/math.glsl"

#define RADIAL_PI 3.14159265358979

struct RadialCorner {
  float start, lean, spline, rounded;
};

RadialCorner radial_corner(float start, float half_angle, float roundness)
{
  return RadialCorner(start, half_angle - start, (1.0 - roundness) * start, roundness * start);
}

// Of a whole segment `half_angle` wide on either side.
RadialCorner radial_own_corner(float half_angle, float roundness)
{
  return radial_corner(half_angle - atan((1.0 - roundness) * tan(half_angle)), half_angle, roundness);
}

float radial_by_middle(RadialCorner c, float size)
{
  return size * tan(c.lean) + c.spline * (0.5 * size + 0.5) + c.rounded;
}

float radial_by_distance(RadialCorner c, float size)
{
  return size * sin(c.lean) + c.spline * (0.5 * size * cos(c.lean) + 0.5) + c.rounded;
}

float radial_along_arc(RadialCorner c, float size, float along)
{
  float near = size * cos(c.lean);
  float bent = along < c.spline ? near * along + 0.5 * (1.0 - near) * along * along / c.spline :
                                  c.spline * (0.5 * near - 0.5) + along;
  return size * sin(c.lean) + bent;
}

// Distance along the middle of the side, the coordinate across, and how large that may be, at an angle to the nearest
// divider. `middle`: distance where the arc has `size`.
vec3 radial_arc(RadialCorner c, float size, float middle, float angle)
{
  float along = c.start - abs(angle);
  float widest = mix(radial_by_middle(c, middle), radial_by_distance(c, size), along / c.start);
  return vec3(middle, radial_along_arc(c, size, along), widest);
}

// The same where the side is straight, at an angle to its middle.
vec3 radial_straight(RadialCorner c, float size, float angle)
{
  float middle = size * cos(angle);
  return vec3(middle, middle * tan(abs(angle)), radial_by_middle(c, middle));
}

// Of a circle about a point, the distance from the origin in a direction.
float radial_to_circle(vec2 center, float radius, float angle)
{
  float along = cos(angle) * center.x + sin(angle) * center.y;
  return along + sqrt(max(along * along + radius * radius - dot(center, center), 0.0));
}

vec3 radial_whole_arc(RadialCorner c, float roundness, float half_angle, float size, float angle)
{
  float nearest = angle > half_angle ? angle - 2.0 * half_angle : angle;
  vec2 center = vec2((1.0 - roundness) / cos(half_angle), 0.0);
  return radial_arc(c, size, size / radial_to_circle(center, roundness, nearest), nearest);
}

// `turn`: of the place; `angle`: in its segment. Also gives the middle's angle and the segment's width.
vec3 radial_irregular(
  float sides, float roundness, vec2 place, float size, float turn, float angle, out float middle, out float width)
{
  float half_angle = RADIAL_PI / sides;
  float last = RADIAL_PI - floor(sides) * half_angle;
  RadialCorner own = radial_own_corner(half_angle, roundness);
  RadialCorner inner = radial_own_corner(last, roundness);
  float radius = roundness * tan(last) / tan(0.5 * (half_angle + last));
  vec2 center = vec2(cos(inner.start), -sin(inner.start)) / cos(inner.lean) + radius * vec2(-cos(last), sin(last));
  vec2 end = center + radius * vec2(cos(half_angle), sin(half_angle));
  float outer_start = atan(end.y / end.x);
  float outer_roundness = 1.0 - tan(half_angle - outer_start) / tan(half_angle);
  RadialCorner outer = radial_corner(outer_start, half_angle, outer_roundness);
  float rest = 2.0 * RADIAL_PI - 2.0 * last;  // where the last segment begins
  middle = half_angle;
  width = tan(own.lean) + own.spline + own.rounded;
  if (turn >= outer.start && turn < rest - outer.start) {
    bool is_beside_last = turn >= rest - half_angle || turn < half_angle;
    bool is_straight = angle >= own.start && angle < 2.0 * half_angle - own.start;
    if (is_straight || turn >= rest - own.start || turn < own.start) {
      RadialCorner c = own;
      if (is_beside_last) {
        c = outer;
      }
      return radial_straight(c, size, half_angle - angle);
    }
    return radial_whole_arc(own, roundness, half_angle, size, angle);
  }
  float ratio = cos(half_angle) / cos(last);
  float last_width = tan(inner.lean) + inner.spline * (0.5 + 0.5 * ratio) + ratio * inner.rounded;
  if (turn >= rest + inner.start && turn < 2.0 * RADIAL_PI - inner.start) {
    middle = last;
    width = last_width;
    return ratio * radial_straight(inner, size, last - angle);
  }
  float nearest = math_arc_tangent(place.y, place.x);
  if (turn >= rest - outer.start && turn < 2.0 * RADIAL_PI - last) {
    nearest = -(nearest + 2.0 * last);
  }
  float along_last = size / radial_to_circle(center, radius, nearest);
  if (nearest < 0.0) {
    middle = last;
    width = last_width;
    return ratio * radial_arc(inner, size, along_last, nearest);
  }
  return radial_arc(outer, size, ratio * along_last, nearest);
}

// Along the side's middle, across, the segment's width, the middle's angle.
vec4 radial_tiling(vec3 vector, float sides, float roundness, bool normalizes)
{
  sides = max(sides, 2.0);
  roundness = clamp(roundness, 0.0, 1.0);
  vec2 place = vector.xy;
  float half_angle = RADIAL_PI / sides;
  float turn = math_arc_tangent(place.y, place.x) + (place.y < 0.0 ? 2.0 * RADIAL_PI : 0.0);
  float segment = floor(turn / (2.0 * half_angle));
  float angle = turn - segment * 2.0 * half_angle;
  float size = length(place);
  float middle = half_angle;
  float width;
  vec3 found;
  bool is_line = sides == 2.0 && roundness == 0.0;
  if (fract(sides) == 0.0) {
    RadialCorner own = radial_own_corner(half_angle, roundness);
    bool is_arc = roundness > 0.0 && (angle >= 2.0 * half_angle - own.start || angle < own.start);
    found = is_arc || roundness == 1.0 ? radial_whole_arc(own, roundness, half_angle, size, angle) :
                                         radial_straight(own, size, half_angle - angle);
    width = is_line ? 0.0 : tan(own.lean) + own.spline + own.rounded;
  }
  else {
    found = radial_irregular(sides, roundness, place, size, turn, angle, middle, width);
  }
  float across = angle < middle ? -found.y : found.y;
  across = place == vec2(0.0) ? 0.0 : (normalizes && !is_line ? across / found.z : across);
  vec2 coordinates = normalizes ? vec2(found.x, 0.5 * across + 0.5) : vec2(found.x - 1.0, across);
  return vec4(coordinates, width, segment * 2.0 * half_angle + middle);
}

float radial_segment(vec3 vector, float sides)
{
  float turn = math_arc_tangent(vector.y, vector.x) / (2.0 * RADIAL_PI);
  return floor(max(sides, 2.0) * (turn + (vector.y < 0.0 ? 1.0 : 0.0)));
}
