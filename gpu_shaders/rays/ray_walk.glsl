// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The first triangle on a ray, by a walk of two levels of bounding-volume hierarchies: of the placed meshes, and in
// each mesh of its triangles in object space. Needs the sampler (FLOAT_2D) `rays` and the push constant (IVEC4)
// `rays_top` of renderer/rays/ray_scene.py: first record of the top level's nodes, of its instances, of its materials.
//
// Records of an inner node, for each of its two children: lowest corner, link; highest corner, count. count 0: an
// inner node, link is its number; count < 0: link is an instance; count > 0: link is the first of so many triangles.
// Of a triangle: corner A; edges B - A and C - A; numbers of its corners and its material slot. Object space.
// Of a corner: normal; number of its vertex.
// Of an instance: three rows from world to object space; (object_id, mirror, what sees it, length that counts as
// none on itself); (first records of nodes, triangles and corners over REGION_UNIT, first material); (number of
// materials, first record of attributes over REGION_UNIT, first of their places, row of instance_table).
#include "common/records.glsl"
#include "rays/hit_attributes.glsl"

// What the walk is at: no node, so that it takes the next of its stack; at its end.
#define NOWHERE -1
#define OVER 99
// Share of a triangle by which its edges overlap the neighbors', or rounding would let rays through between them.
#define OVERLAP 2e-6
// How far off a surface rays begin, by the share of the place's coordinates that rounding may have moved it.
#define OFF_SURFACE 2e-6
#ifdef LIGHTING_SHADOWS_LINKED
#from renderer.surfaces.light_sets import SHADOW_SET_SHIFT
#from scene.arrays import EVERY_SET
// Bits of the shadow sets whose instances are there.
int walk_blockers = EVERY_SET;
#endif

// Where a ray that leaves a surface begins.
vec3 off_surface(vec3 position, vec3 normal)
{
  vec3 size = abs(position);
  return position + normal * (OFF_SURFACE * (max(size.x, max(size.y, size.z)) + 1e-4));
}

#ifdef KNOWS_ESCAPES
// The ray does not meet again what it starts on.
bool walk_escapes = false;
#endif

struct Ray {
  vec3 origin;
  vec3 direction;  // of any length, in object space; distances are in lengths of the world's unit vector
  vec3 inverse;
};

struct Hit {
  float range;    // distance along the ray
  int instance;   // first record; -1: nothing was hit
  int triangle;   // first record
  vec2 place;     // barycentric weights of B and C
  float visited;  // nodes looked at
#ifdef WITH_COUNTS
  float tested;   // triangles
  float entered;  // instances
#endif
};

#ifdef PATH_STEP
// 1: the ray starts outside of the closed mesh that it starts on, -1: inside.
float own_side = 1.0;
// Share of the length that counts as none within which two surfaces touch: a millionth of the size.
#define TOUCHES 1e-2
// Where along the ray boxes begin to count: a little before its start, as what touches there may lie on either side.
float first_range = 0.0;
#else
#define first_range 0.0
#endif

Ray ray_along(vec3 origin, vec3 direction)
{
  Ray ray;
  ray.origin = origin;
  ray.direction = direction;
  vec3 away = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
  ray.inverse = 1.0 / away;
  return ray;
}

// Where the ray enters a box, or a number beyond `farthest`.
float entry(Ray ray, vec3 low, vec3 high, float farthest)
{
  vec3 first = (low - ray.origin) * ray.inverse;
  vec3 second = (high - ray.origin) * ray.inverse;
  vec3 near = min(first, second);
  vec3 far = max(first, second);
  float enter = max(max(near.x, near.y), max(near.z, first_range));
  // Grown by what rounding may take away.
#ifdef PATH_STEP
  float leave = min(min(far.x, far.y), min(far.z, farthest));
  leave += 1e-6 * abs(leave);
#else
  float leave = min(min(far.x, far.y), min(far.z, farthest)) * 1.000001;
#endif
  return enter <= leave ? enter : 3e38;
}

int packed_child(float link, float count)
{
  return (int(link) << 4) + int(count) + 1;
}

#ifdef LIGHT_THROUGH
// What gets through all that the last walk with `any_hit` has met and light goes straight on through.
vec3 walked_light = vec3(1.0);

// Of a triangle of an instance, records both, at this place on it.
vec3 light_through_triangle(int instance, int triangle, vec2 place)
{
  vec3 weights = vec3(1.0 - place.x - place.y, place);
  int slot = min(int(fetch_record(rays, triangle + 3).w), int(fetch_record(rays, instance + 5).x) - 1);
  int first = rays_top.z + int(fetch_record(rays, instance + 4).w);
  int material = int(fetch_record(rays, first + slot / 4)[slot % 4]);
  int number = light_through_attribute(material);
  return light_through(material, number < 0 ? vec2(0.0) : hit_attribute(instance, triangle, weights, number).xy);
}
#endif

// `own`: mirror (of a step of paths: object_id of what) that the ray starts on, 0: none; a closed one then counts
// where it faces the ray, as a ray below the facet that it starts on, by a shading normal, would else see the inside.
// `seen_by`: which instances count. With `any_hit` whatever is nearer than `farthest` ends the walk; with
// LIGHT_THROUGH what light goes straight on through only once none is left.
Hit walk(vec3 origin, vec3 direction, float farthest, int seen_by, float own, bool any_hit)
{
  Hit hit;
  hit.range = farthest;
  hit.instance = -1;
  hit.triangle = 0;
  hit.place = vec2(0.0);
  hit.visited = 0.0;
#ifdef WITH_COUNTS
  hit.tested = hit.entered = 0.0;
#endif
  Ray world = ray_along(origin, direction);
  Ray ray = world;
  int stack[STACK];
  float entries[STACK];
  int top = 0;
  int outside = -1;    // stack height at which the walk leaves the mesh it is in
  int nodes = rays_top.x;
  int triangles = 0;
  int instance = -1;
  float nearest = 0.0;
#ifdef LIGHT_THROUGH
  bool is_clear = false;
  walked_light = vec3(1.0);
#endif
#ifdef PATH_STEP
  float near_end = 0.0;     // nearer than this only the side `near_facing` counts
  float near_facing = 0.0;
  vec3 lowest = min(fetch_record(rays, nodes).xyz, fetch_record(rays, nodes + 2).xyz);
  vec3 highest = max(fetch_record(rays, nodes + 1).xyz, fetch_record(rays, nodes + 3).xyz);
  float top_first = -TOUCHES * 1e-4 * length(highest - lowest);
  first_range = top_first;
#endif
  float facing = 0.0;  // 0: both sides of triangles count; 1: that of the winding's normal; -1: the other
  // Where the walk is: link and count as in a node's record, or NOWHERE, or OVER.
  int link = 0;
  int count = 0;
  // (Loops inside loops, as a group of pixels runs all branches of a loop's body: it is most often among inner nodes.)
  do {
    do {
      if (link == NOWHERE) {
        // On with the nearest subtree that was put off.
        if (top == outside) {
          outside = -1;
          ray = world;
          nodes = rays_top.x;
#ifdef PATH_STEP
          first_range = top_first;
#endif
        }
        if (top == 0) {
          count = OVER;
        }
        else {
          top--;
          if (entries[top] < hit.range) {
            link = stack[top] >> 4;
            count = (stack[top] & 15) - 1;
          }
        }
      }
      if (count == 0 && link != NOWHERE) {
        int node = nodes + NODE_RECORDS * link;
        vec4 low_1 = fetch_record(rays, node);
        vec4 high_1 = fetch_record(rays, node + 1);
        vec4 low_2 = fetch_record(rays, node + 2);
        vec4 high_2 = fetch_record(rays, node + 3);
        hit.visited += 1.0;
        float enter_1 = entry(ray, low_1.xyz, high_1.xyz, hit.range);
        float enter_2 = entry(ray, low_2.xyz, high_2.xyz, hit.range);
        bool swapped = enter_2 < enter_1;
        float later = max(enter_1, enter_2);
        if (later < 3e38) {
          stack[top] = swapped ? packed_child(low_1.w, high_1.w) : packed_child(low_2.w, high_2.w);
          entries[top] = later;
          top++;
        }
        bool enters = min(enter_1, enter_2) < 3e38;
        link = enters ? int(swapped ? low_2.w : low_1.w) : NOWHERE;
        count = enters ? int(swapped ? high_2.w : high_1.w) : 0;
      }
    } while (count == 0);
    if (count < 0) {
      int record = rays_top.y + INSTANCE_RECORDS * link;
      vec4 about = fetch_record(rays, record + 3);
      int flags = int(about.z);
#ifdef LIGHTING_SHADOWS_LINKED
      flags *= (walk_blockers >> (flags >> SHADOW_SET_SHIFT)) & 1;
#endif
#ifdef PATH_STEP
      bool is_own = abs(about.x - own) < 0.5;
      bool never = own_side > 0.0 && (flags & NEVER_SEES_ITSELF) != 0;
#else
      bool is_own = about.y > 0.5 && abs(about.y - own) < 0.5;
      bool never = (flags & NEVER_SEES_ITSELF) != 0;
#ifdef KNOWS_ESCAPES
      never = never || walk_escapes;
#endif
#endif
      link = NOWHERE;
      if ((flags & seen_by) != 0 && !(is_own && never)) {
#ifdef WITH_COUNTS
        hit.entered += 1.0;
#endif
        vec4 x = fetch_record(rays, record);
        vec4 y = fetch_record(rays, record + 1);
        vec4 z = fetch_record(rays, record + 2);
        vec4 regions = fetch_record(rays, record + 4);
        vec4 start = vec4(origin, 1.0);
        ray = ray_along(vec3(dot(x, start), dot(y, start), dot(z, start)),
                        vec3(dot(x.xyz, direction), dot(y.xyz, direction), dot(z.xyz, direction)));
#ifdef LIGHT_THROUGH
        is_clear = any_hit && (flags & CASTS_IN_PART) != 0;
#endif
        nearest = is_own ? about.w : 0.0;
        bool one_sided = is_own && (flags & IS_CLOSED) != 0;
        facing = one_sided ? ((flags & IS_MIRRORED) != 0 ? -1.0 : 1.0) : 0.0;
#ifdef PATH_STEP
        // Inside of it a path may meet what reaches into it, from both sides, but not where it has just come in:
        // what is near has to be seen from inside.
        near_end = 0.0;
        first_range = 0.0;
        if (!is_own) {
          // A path that comes out of a thing enters what that stands on, and does not meet what it comes out of again.
          near_end = TOUCHES * about.w;
          near_facing = (flags & IS_MIRRORED) != 0 ? -1.0 : 1.0;
          nearest = first_range = -near_end;
        }
        else if (one_sided && own_side < 0.0) {
          near_end = nearest;
          near_facing = -facing;
          nearest = facing = 0.0;
        }
#endif
        instance = record;
        nodes = REGION_UNIT * int(regions.x);
        triangles = REGION_UNIT * int(regions.y);
        outside = top;
        link = 0;
      }
      count = 0;
    }
    else if (count != OVER) {
#ifdef WITH_COUNTS
      hit.tested += float(count);
#endif
      do {
        int triangle = triangles + TRIANGLE_RECORDS * link;
        vec3 a = fetch_record(rays, triangle).xyz;
        vec3 ab = fetch_record(rays, triangle + 1).xyz;
        vec3 ac = fetch_record(rays, triangle + 2).xyz;
        // Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection" (1997)
        vec3 p = cross(ray.direction, ac);
        float determinant = dot(ab, p);
        vec3 offset = ray.origin - a;
        vec3 q = cross(offset, ab);
        float scale = 1.0 / determinant;
        vec2 place = vec2(dot(offset, p), dot(ray.direction, q)) * scale;
        float range = dot(ac, q) * scale;
        // (Comparisons with what is not a number fail.)
        if (place.x >= -OVERLAP && place.y >= -OVERLAP && place.x + place.y <= 1.0 + OVERLAP && range > nearest &&
#ifdef PATH_STEP
            (range > near_end || determinant * near_facing >= 0.0) &&
#endif
            range < hit.range && determinant * facing >= 0.0) {
#ifdef LIGHT_THROUGH
          walked_light *= is_clear ? light_through_triangle(instance, triangle, place) : vec3(0.0);
          if (is_clear && walked_light != vec3(0.0)) {
            link++;
            count--;
            continue;
          }
#endif
          hit.range = range;
          hit.instance = instance;
          hit.triangle = triangle;
          hit.place = place;
        }
        link++;
        count--;
      } while (count > 0);
      link = NOWHERE;
      count = any_hit && hit.instance >= 0 ? OVER : 0;
    }
  } while (count != OVER);
  return hit;
}
