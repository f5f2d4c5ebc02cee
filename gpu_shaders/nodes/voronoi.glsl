// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: 2013 Inigo Quilez (MIT)
// SPDX-FileCopyrightText: 2011-2026 Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Voronoi Texture, after Cycles (svm/voronoi.h). Places have four numbers, of which the first `dimensions` count and
// the rest are 0. Dimensions, feature, metric are constants in every call: compilers leave out what is not asked for.
#include "nodes/texture_hash.glsl"

#define VORONOI_EUCLIDEAN 0
#define VORONOI_MANHATTAN 1
#define VORONOI_CHEBYCHEV 2
#define VORONOI_MINKOWSKI 3
#define VORONOI_F1 0
#define VORONOI_F2 1
#define VORONOI_SMOOTH_F1 2
#define VORONOI_FAR 3.402823466e+38

struct VoronoiPoint {
  float distance;
  vec3 color;
  vec4 position;
};

// Distances

vec4 voronoi_powers(vec4 x, int dimensions, float exponent)
{
  // (0 to the power of 0 would be none of GLSL's.)
  vec4 powers = pow(x, vec4(exponent));
  return powers * vec4(1.0, dimensions > 1, dimensions > 2, dimensions > 3);
}

// Grows with the distance, and is cheaper.
float voronoi_bound(vec4 away, int dimensions, int metric, float exponent)
{
  if (metric == VORONOI_EUCLIDEAN) {
    return dot(away, away);
  }
  away = abs(away);
  if (metric == VORONOI_MANHATTAN) {
    return away.x + away.y + away.z + away.w;
  }
  if (metric == VORONOI_CHEBYCHEV) {
    return max(max(away.x, away.y), max(away.z, away.w));
  }
  return dot(voronoi_powers(away, dimensions, exponent), vec4(1.0));
}

float voronoi_distance(vec4 away, int dimensions, int metric, float exponent)
{
  float bound = voronoi_bound(away, dimensions, metric, exponent);
  if (metric == VORONOI_EUCLIDEAN) {
    return sqrt(bound);
  }
  return metric == VORONOI_MINKOWSKI ? pow(bound, 1.0 / exponent) : bound;
}

// Cells

// Where the point of a cell is in it.
vec4 voronoi_random(ivec4 cell, int dimensions)
{
  if (dimensions == 1) {
    return vec4(hash_unit(float(cell.x)), 0.0, 0.0, 0.0);
  }
  if (dimensions == 2) {
    return vec4(pcg_unit(cell.xy), 0.0, 0.0);
  }
  return dimensions == 3 ? vec4(pcg_unit(cell.xyz), 0.0) : pcg_unit(cell);
}

vec3 voronoi_color(ivec4 cell, int dimensions)
{
  if (dimensions == 1) {
    return hash_color(float(cell.x));
  }
  if (dimensions == 2) {
    return pcg_unit(ivec3(cell.xy, 0));
  }
  return dimensions == 3 ? pcg_unit(cell.xyz) : pcg_unit(cell).xyz;
}

// How many neighbors there are, `side` along each axis.
int voronoi_count(int side, int dimensions)
{
  int square = side * side;
  return dimensions == 1 ? side : dimensions == 2 ? square : dimensions == 3 ? square * side : square * square;
}

ivec4 voronoi_neighbor(int number, int side, int dimensions)
{
  ivec4 axes = ivec4(1, dimensions > 1, dimensions > 2, dimensions > 3);
  ivec4 place = ivec4(number, number / side, number / (side * side), number / (side * side * side)) % side;
  return (place - side / 2) * axes;
}

// The point of a neighbor, as seen from the cell's corner. (One point is the same number from everywhere, and Cycles'
// to the last bit, as it may be hashed: compilers may not round it in their own way, here and where it is scaled.)
vec4 voronoi_point(ivec4 cell, ivec4 neighbor, int dimensions, float randomness)
{
  precise vec4 point = vec4(neighbor) + voronoi_random(cell + neighbor, dimensions) * randomness;
  return point;
}

// Features of one octave

VoronoiPoint voronoi_f1(vec4 p, int dimensions, int metric, float exponent, float randomness)
{
  vec4 low = floor(p), place = p - low, nearest = vec4(0.0);
  ivec4 cell = ivec4(low), owner = cell;
  float least = VORONOI_FAR;
  for (int i = 0; i < voronoi_count(3, dimensions); i++) {
    ivec4 neighbor = voronoi_neighbor(i, 3, dimensions);
    vec4 point = voronoi_point(cell, neighbor, dimensions, randomness);
    float bound = voronoi_bound(point - place, dimensions, metric, exponent);
    if (bound < least) {
      least = bound;
      nearest = point;
      owner = cell + neighbor;
    }
  }
  float distance = voronoi_distance(nearest - place, dimensions, metric, exponent);
  return VoronoiPoint(distance, voronoi_color(owner, dimensions), low + nearest);
}

VoronoiPoint voronoi_f2(vec4 p, int dimensions, int metric, float exponent, float randomness)
{
  vec4 low = floor(p), place = p - low, first = vec4(0.0), second = vec4(0.0);
  ivec4 cell = ivec4(low), first_owner = cell, second_owner = cell;
  float least = VORONOI_FAR, next = VORONOI_FAR;
  for (int i = 0; i < voronoi_count(3, dimensions); i++) {
    ivec4 neighbor = voronoi_neighbor(i, 3, dimensions);
    vec4 point = voronoi_point(cell, neighbor, dimensions, randomness);
    float bound = voronoi_bound(point - place, dimensions, metric, exponent);
    if (bound < least) {
      next = least;
      second = first;
      second_owner = first_owner;
      least = bound;
      first = point;
      first_owner = cell + neighbor;
    }
    else if (bound < next) {
      next = bound;
      second = point;
      second_owner = cell + neighbor;
    }
  }
  float distance = voronoi_distance(second - place, dimensions, metric, exponent);
  return VoronoiPoint(distance, voronoi_color(second_owner, dimensions), low + second);
}

// All points of the cells around, blended by their distances, one after the other.
VoronoiPoint voronoi_smooth_f1(vec4 p, int dimensions, int metric, float exponent, float randomness, float smoothness)
{
  vec4 low = floor(p), place = p - low;
  ivec4 cell = ivec4(low);
  // (What is hardly smooth is F1.)
  smoothness = max(smoothness, 1e-12);
  VoronoiPoint blend = VoronoiPoint(0.0, vec3(0.0), vec4(0.0));
  for (int i = 0; i < voronoi_count(5, dimensions); i++) {
    ivec4 neighbor = voronoi_neighbor(i, 5, dimensions);
    vec4 point = voronoi_point(cell, neighbor, dimensions, randomness);
    float distance = voronoi_distance(point - place, dimensions, metric, exponent);
    float share = smoothstep(0.0, 1.0, 0.5 + 0.5 * (blend.distance - distance) / smoothness);
    share = i == 0 ? 1.0 : share;
    float correction = smoothness * share * (1.0 - share);
    blend.distance = mix(blend.distance, distance, share) - correction;
    correction /= 1.0 + 3.0 * smoothness;
    blend.color = mix(blend.color, voronoi_color(cell + neighbor, dimensions), share) - correction;
    blend.position = mix(blend.position, point, share) - correction;
  }
  blend.position += low;
  return blend;
}

float voronoi_edge(vec4 p, int dimensions, float randomness)
{
  vec4 low = floor(p), place = p - low, nearest = vec4(0.0);
  ivec4 cell = ivec4(low);
  float least = VORONOI_FAR;
  for (int i = 0; i < voronoi_count(3, dimensions); i++) {
    vec4 away = voronoi_point(cell, voronoi_neighbor(i, 3, dimensions), dimensions, randomness) - place;
    float squared = dot(away, away);
    if (squared < least) {
      least = squared;
      nearest = away;
    }
  }
  least = VORONOI_FAR;
  for (int i = 0; i < voronoi_count(3, dimensions); i++) {
    vec4 away = voronoi_point(cell, voronoi_neighbor(i, 3, dimensions), dimensions, randomness) - place;
    vec4 across = away - nearest;
    float squared = dot(across, across);
    if (squared > 0.0001) {
      least = min(least, dot((nearest + away) / 2.0, across * inversesqrt(squared)));
    }
  }
  return least;
}

// On a line it is the middles between the cell's own point and its neighbors' that count.
float voronoi_line_edge(float p, float randomness)
{
  float low = floor(p), place = p - low;
  float middle = hash_unit(low) * randomness;
  float left = hash_unit(low - 1.0) * randomness - 1.0;
  float right = hash_unit(low + 1.0) * randomness + 1.0;
  return min(abs((middle + left) / 2.0 - place), abs((middle + right) / 2.0 - place));
}

// Half of the way from the nearest point to its own nearest.
float voronoi_n_sphere_radius(vec4 p, int dimensions, float randomness)
{
  vec4 low = floor(p), place = p - low, nearest = vec4(0.0);
  ivec4 cell = ivec4(low), owner = ivec4(0);
  float least = VORONOI_FAR;
  for (int i = 0; i < voronoi_count(3, dimensions); i++) {
    ivec4 neighbor = voronoi_neighbor(i, 3, dimensions);
    vec4 point = voronoi_point(cell, neighbor, dimensions, randomness);
    float squared = dot(point - place, point - place);
    if (squared < least) {
      least = squared;
      nearest = point;
      owner = neighbor;
    }
  }
  least = VORONOI_FAR;
  for (int i = 0; i < voronoi_count(3, dimensions); i++) {
    ivec4 neighbor = voronoi_neighbor(i, 3, dimensions);
    if (neighbor != ivec4(0)) {
      vec4 across = voronoi_point(cell, neighbor + owner, dimensions, randomness) - nearest;
      least = min(least, dot(across, across));
    }
  }
  return sqrt(least) / 2.0;
}

// Octaves. `detail` is from 0 to 15; its fraction is a share of the last.

VoronoiPoint voronoi_feature(vec4 p, int feature, int dimensions, int metric, float exponent, float randomness,
                             float smoothness)
{
  if (feature == VORONOI_F2) {
    return voronoi_f2(p, dimensions, metric, exponent, randomness);
  }
  if (feature == VORONOI_SMOOTH_F1) {
    return voronoi_smooth_f1(p, dimensions, metric, exponent, randomness, smoothness);
  }
  return voronoi_f1(p, dimensions, metric, exponent, randomness);
}

// `per_scale`: from p to the texture's coordinates.
VoronoiPoint voronoi_octaves(vec4 p, int feature, int dimensions, int metric, bool normalized, float per_scale,
                             float detail, float roughness, float lacunarity, float smoothness, float exponent,
                             float randomness)
{
  VoronoiPoint sum = VoronoiPoint(0.0, vec3(0.0), vec4(0.0));
  float weight = 1.0, weights = 0.0, octave_scale = 1.0;
  bool is_single = detail == 0.0 || roughness == 0.0;
  int last = is_single ? 0 : int(ceil(detail));
  for (int i = 0; i <= last; i++) {
    VoronoiPoint octave = voronoi_feature(p * octave_scale, feature, dimensions, metric, exponent, randomness,
                                          smoothness);
    if (is_single) {
      weights = 1.0;
      sum = octave;
      break;
    }
    float share = float(i) <= detail ? 1.0 : fract(detail);
    weights += share * weight;
    sum.distance += share * weight * octave.distance;
    sum.color += share * weight * octave.color;
    sum.position = mix(sum.position, octave.position * (1.0 / octave_scale), share * weight);
    octave_scale *= lacunarity;
    weight *= roughness;
  }
  if (normalized) {
    vec4 corner = vec4(voronoi_neighbor(voronoi_count(3, dimensions) - 1, 3, dimensions)) * (0.5 + 0.5 * randomness);
    float most = voronoi_distance(corner, dimensions, metric, exponent) * (feature == VORONOI_F2 ? 2.0 : 1.0);
    sum.distance /= weights * most;
    sum.color /= weights;
  }
  precise vec4 position = sum.position * per_scale;
  sum.position = position;
  return sum;
}

float voronoi_edge_octaves(vec4 p, int dimensions, bool normalized, float detail, float roughness, float lacunarity,
                           float randomness)
{
  float most = 0.5 + 0.5 * randomness;
  float distance = 8.0, weight = 1.0, reach = most, octave_scale = 1.0;
  bool is_single = detail == 0.0 || roughness == 0.0;
  int last = is_single ? 0 : int(ceil(detail));
  for (int i = 0; i <= last; i++) {
    float octave;
    if (dimensions == 1) {
      octave = voronoi_line_edge(p.x * octave_scale, randomness);
    }
    else {
      octave = voronoi_edge(p * octave_scale, dimensions, randomness);
    }
    if (is_single) {
      distance = octave;
      break;
    }
    float share = float(i) <= detail ? 1.0 : fract(detail);
    reach = mix(reach, most / octave_scale, share * weight);
    distance = mix(distance, min(distance, octave / octave_scale), share * weight);
    octave_scale *= lacunarity;
    weight *= roughness;
  }
  return normalized ? distance / reach : distance;
}
