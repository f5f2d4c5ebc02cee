// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The end of every vertex solver, after the method's `solve` (see solver.glsl): which vertices, and where results go.
// It comes last and not as an include, because not every graphics interface lets a function be declared before its
// body. Writes the records `reflection_points` and `virtual_positions`. Of a method with a second pass over what the
// first has not settled the first lists it in the images `stragglers` and `straggler_count` (LISTS_STRAGGLERS), and
// the second takes that list (TAKES_STRAGGLERS). Without image atomics the second looks at all (SEEKS_STRAGGLERS); by
// fragments the first marks them by its depth (MARKS_RECORDS), and the second runs at that depth alone.

// reflection_points: P and status + 4 iterations. virtual_positions: where the vertex seems to be, and |PV|.
void store(int index, Solved solved)
{
  WRITE_RECORD(reflection_points, index, vec4(solved.point, float(solved.status + 4 * solved.iterations)));
  WRITE_RECORD(virtual_positions, index, vec4(solved.virtual_position, solved.length_to_vertex));
}

vec3 vertex_in_map(int index)
{
  return in_map(fetch_record(positions, index).xyz);
}

#ifdef TAKES_STRAGGLERS

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
#ifdef MARKS_RECORDS
  gl_FragDepth = 1.0;
#endif
  if (index >= solver.count) {
    WRITE_NONE;
  }
#ifdef SEEKS_STRAGGLERS
  if ((int(imageLoad(reflection_points, texel_of_record(index)).w + 0.5) & 3) != UNSOLVED) {
    return;
  }
#endif
  vec3 vertex = vertex_in_map(index);
  if (!is_finite(vertex)) {
    store(index, as_invalid());
    return;
  }
  Solved solved = solve(index, vertex);
  store(index, solved);
#ifdef MARKS_RECORDS
  gl_FragDepth = solved.status == UNSOLVED ? MARKED : 1.0;
#endif
#ifdef LISTS_STRAGGLERS
  if (solved.status == UNSOLVED) {
    uint place = imageAtomicAdd(straggler_count, ivec2(0), 1u);
    imageStore(stragglers, texel_of_record(int(place)), uvec4(uint(index)));
  }
#endif
}

#endif
