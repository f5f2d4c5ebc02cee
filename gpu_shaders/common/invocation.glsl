// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A pass that computes records: by a compute shader with `dispatch` (renderer/device/shaders.py), or with BY_FRAGMENTS
// by a fragment for each record (renderer/device/ways/record_pass.py).
#include "common/records.glsl"

#ifdef BY_FRAGMENTS

// The fragment's own record is all that it writes.
#define WRITE_RECORD(target, index, record) target = record
#define WRITE_NONE discard

int invocation()
{
  ivec2 texel = ivec2(gl_FragCoord.xy);
  return texel.x + (texel.y << ROW_BITS);
}

// Record of a pass over those from the number `first` on.
int record_from(int first)
{
  return invocation();
}

#else

#define WRITE_RECORD(target, index, record) imageStore(target, texel_of_record(index), record)
#define WRITE_NONE return

int invocation()
{
  return int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x);
}

int record_from(int first)
{
  return first + invocation();
}

#endif
