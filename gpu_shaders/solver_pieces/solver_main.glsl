// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The end of every vertex solver, after the method's `solve` (see solver.glsl): which vertices, and where results go.
// It comes last and not as an include, because not every graphics interface lets a function be declared before its
// body. Needs the images `reflection_points` and `virtual_positions`; of a method with a second pass over what the
// first has not settled also `stragglers` and `straggler_count`, with LISTS_STRAGGLERS or SETTLES_STRAGGLERS for the
// pass.

// reflection_points: P and status + 4 iterations. virtual_positions: where the vertex seems to be, and |PV|.
void store(int index, Solved solved)
{
  ivec2 texel = texel_of_record(index);
  imageStore(reflection_points, texel, vec4(solved.point, float(solved.status + 4 * solved.iterations)));
  imageStore(virtual_positions, texel, vec4(solved.virtual_position, solved.length_to_vertex));
}

vec3 vertex_in_map(int index)
{
  return in_map(fetch_record(positions, index).xyz);
}

#ifdef SETTLES_STRAGGLERS

void main()
{
  int count = int(imageLoad(straggler_count, ivec2(0)).x);
  // As many invocations as were dispatched share any number.
  int stride = int(gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_WorkGroupSize.x);
  for (int place = invocation(); place < count; place += stride) {
    int index = int(imageLoad(stragglers, texel_of_record(place)).x);
    store(index, solve(index, vertex_in_map(index)));
  }
}

#else

void main()
{
  int index = invocation();
  if (index >= solver.count) {
    return;
  }
  vec3 vertex = vertex_in_map(index);
  if (!is_finite(vertex)) {
    store(index, as_invalid());
    return;
  }
  Solved solved = solve(index, vertex);
  store(index, solved);
#ifdef LISTS_STRAGGLERS
  if (solved.status == UNSOLVED) {
    uint place = imageAtomicAdd(straggler_count, ivec2(0), 1u);
    imageStore(stragglers, texel_of_record(int(place)), uvec4(uint(index)));
  }
#endif
}

#endif
