// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where on screen each triangle's reflection may fall: a box around the reflection points of its corners and of the
// middles of its edges. What may cover a pixel center goes on a list.
//
// Records of a triangle in `triangles`: (three positions, material), (three edges, 0), (three corners, 0).
// Of a box in `boxes`: (center, half axis), (other half axis, triangle, 0); pixels.
// `margins`: share of what edges bend that a box is grown by, pixels more, pixels more of triangles that cross the
// horizon, share of their size. `window`: lowest and highest pixel edge of the mirror's window.
#include "common/invocation.glsl"
#include "common/records.glsl"
#include "common/status.glsl"

#define CORNERS 3
#define POINTS 6
#define MOST_POINTS 9
// Slots of `counters`.
#define DRAWN 0
#define CROSSING 1
#define UNBOUNDED 2
#define ALL_HIDDEN 3

vec2 on_screen(vec4 clip)
{
  return (clip.xy / clip.w * 0.5 + 0.5) * screen;
}

vec2 project(vec3 point)
{
  return on_screen(view.view_to_clip * (view.world_to_view * vec4(point, 1.0)));
}

uint counted(int slot)
{
  return imageAtomicAdd(counters, ivec2(slot, chunk), 1u);
}

void put(int triangle, vec2 center, vec2 along, vec2 across)
{
  int place = 2 * int(counted(DRAWN));
  imageStore(boxes, texel_of_record(place), vec4(center, along));
  imageStore(boxes, texel_of_record(place + 1), vec4(across, float(triangle), 0.0));
}

void put_window(int triangle, vec4 box)
{
  vec2 half_size = 0.5 * (box.zw - box.xy);
  put(triangle, box.xy + half_size, vec2(half_size.x, 0.0), vec2(0.0, half_size.y));
}

void main()
{
  int index = invocation();
  if (index >= triangle_count) {
    return;
  }
  vec4 corners = fetch_record(triangles, 3 * index);
  vec4 edges = fetch_record(triangles, 3 * index + 1);
  vec2 points[MOST_POINTS];
  bool reflected[POINTS];
  int hidden = 0;
  int lost = 0;
  int count = 0;
  for (int k = 0; k < POINTS; k++) {
    vec4 solved = k < CORNERS ? fetch_record(corner_points, int(corners[k] + 0.5)) :
                                fetch_record(middle_points, int(edges[k - CORNERS] + 0.5));
    int status = int(solved.w + 0.5) & 3;
    reflected[k] = status == REFLECTED;
    hidden += status == HIDDEN && k < CORNERS ? 1 : 0;
    lost += status >= UNSOLVED ? 1 : 0;
    points[k] = project(solved.xyz);
  }
  // What a convex mirror hides from the eye is convex: with all corners in it the triangle is.
  if (hidden == CORNERS) {
    counted(ALL_HIDDEN);
    return;
  }
  float bend = 0.0;
  for (int k = 0; k < CORNERS; k++) {
    int next = (k + 1) % CORNERS;
    if (reflected[k] && reflected[next] && reflected[CORNERS + k]) {
      bend = max(bend, length(points[CORNERS + k] - 0.5 * (points[k] + points[next])));
    }
  }
  bool is_whole = true;
  for (int k = 0; k < POINTS; k++) {
    is_whole = is_whole && reflected[k];
    if (reflected[k]) {
      points[count++] = points[k];
    }
  }
  float margin = margins.x * bend + margins.y;
  bool is_bounded = lost == 0;
  if (!is_whole) {
    counted(CROSSING);
    // Where the triangle crosses the horizon it is reflected on the mirror's outline, just where it is seen directly:
    // the reflection lies between the reflected points and what the eye sees of the triangle.
    margin = margins.x * bend + margins.z;
    for (int k = 0; k < CORNERS; k++) {
      vec4 place = vec4(fetch_record(positions, int(corners[k] + 0.5)).xyz, 1.0);
      vec4 clip = view.view_to_clip * (view.world_to_view * place);
      is_bounded = is_bounded && clip.w > 1e-6;
      points[count++] = on_screen(clip);
    }
  }
  if (!is_bounded) {
    counted(UNBOUNDED);
    put_window(index, window);
    return;
  }
  vec2 mean = vec2(0.0);
  vec2 low = points[0];
  vec2 high = points[0];
  for (int k = 0; k < count; k++) {
    mean += points[k] / float(count);
    low = min(low, points[k]);
    high = max(high, points[k]);
  }
  if (!is_whole) {
    margin += margins.w * max(high.x - low.x, high.y - low.y);
  }
  vec4 box = vec4(max(low - margin, window.xy), min(high + margin, window.zw));
  // Without a pixel center inside there is nothing to draw.
  if (any(greaterThan(ceil(box.xy - 0.5), floor(box.zw - 0.5)))) {
    return;
  }
  vec3 spread = vec3(0.0);
  for (int k = 0; k < count; k++) {
    vec2 offset = points[k] - mean;
    spread += vec3(offset * offset, offset.x * offset.y);
  }
  float turn = 0.5 * atan(2.0 * spread.z, spread.x - spread.y + 1e-30);
  vec2 along = vec2(cos(turn), sin(turn));
  vec2 across = vec2(-along.y, along.x);
  vec2 least = vec2(1e30);
  vec2 most = vec2(-1e30);
  for (int k = 0; k < count; k++) {
    vec2 place = vec2(dot(points[k] - mean, along), dot(points[k] - mean, across));
    least = min(least, place);
    most = max(most, place);
  }
  least -= margin;
  most += margin;
  vec2 size = most - least;
  if (size.x * size.y < (box.z - box.x) * (box.w - box.y)) {
    vec2 middle = 0.5 * (least + most);
    put(index, mean + middle.x * along + middle.y * across, 0.5 * size.x * along, 0.5 * size.y * across);
  }
  else {
    put_window(index, box);
  }
}
