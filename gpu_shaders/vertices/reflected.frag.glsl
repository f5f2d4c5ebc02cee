// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Hidden surfaces of the reflected scene, three ways, without a stencil (Roger & Holzschuch 2006, section 3.3.6).
#include "surfaces/material_records.glsl"
#ifdef PROGRAM
#include "surfaces/material_at.glsl"
#include "programs/point_of_fragment.glsl"
#endif
#include "surfaces/fill_buffers.glsl"

vec3 towards_eye(vec3 point)
{
  return normalize(view.eye.xyz - point * view.eye.w);
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  // 1. Scene over reflector, one reflector over another: the surface seen at this pixel is another one.
  if (texelFetch(mirror_color, pixel, 0).w != mirror) {
    discard;
  }
  // A vertex without a solution takes its triangles along; a triangle of hidden vertices has nothing to show.
  if (rejected.x > 0.0 || rejected.y > 0.9999) {
    discard;
  }
  vec3 seen_point = texelFetch(mirror_position, pixel, 0).xyz;
  vec3 normal = texelFetch(mirror_normal, pixel, 0).xyz;
  vec3 to_vertex = world_position - seen_point;
  float vertex_distance = length(to_vertex);
  // Behind the mirror at this pixel, where a triangle goes on past the horizon.
  if (dot(normal, to_vertex) <= 0.0) {
    discard;
  }
  // A triangle whose vertices found different images of a mirror that bends both ways stretches across what lies
  // between.
  vec3 ray = reflect(-towards_eye(seen_point), normal);
  if (dot(ray, to_vertex) < stretched * vertex_distance) {
    discard;
  }
#ifdef BACK_FACES
  // 2. Reflector over itself: the reflection point lies behind a back face that this pixel's ray meets first.
  vec3 to_point = reflection_point - view.eye.xyz * view.eye.w;
  float point_distance = view.eye.w > 0.0 ? length(to_point) : -dot(to_point, view.eye.xyz);
  float back_distance = texelFetch(back_faces, pixel, 0).x;
  if (back_distance > 0.0 && point_distance > back_distance) {
    discard;
  }
#endif
  // 3. Reflected scene over itself: depth is the distance from the mirror, per fragment, as interpolated distances of
  // thin layers cross each other.
  gl_FragDepth = vertex_distance / (vertex_distance + depth_scale);

  vec3 surface = normalize(world_normal);
  surface = dot(surface, to_vertex) > 0.0 ? -surface : surface;
#ifdef PROGRAM
  Material m = material_constants(int(material));
  ShadingPoint s = point_of_fragment(surface);
  // What sees it is the mirror.
  s.incoming = -to_vertex / vertex_distance;
  s.ray_length = vertex_distance;
  s.ray = RAY_IS_REFLECTION | RAY_IS_GLOSSY | RAY_IS_SINGULAR;
  s.depths = vec3(1.0, 0.0, 1.0);
  s.is_back = dot(normalize(world_normal), to_vertex) > 0.0;
  s.normal = surface;
  vec3 facing = dot(s.true_normal, to_vertex) > 0.0 ? -s.true_normal : s.true_normal;
  s.true_normal = facing;
  m.normal = surface;
  material_program(s, m);
  surface = m.normal;
  vec3 color = m.base_color;
  fill_buffers(m);
#else
  vec3 color = base_color;
  fill_buffers();
#endif
  surface_position = vec4(world_position, object_id);
  surface_normal = vec4(surface, material);
  surface_color_out = vec4(color, iterations);
}
