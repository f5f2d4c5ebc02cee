// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What rays there were, before there is any light.

void main()
{
  color = vec4(vec3(0.0), texelFetch(gather_weight, ivec2(gl_FragCoord.xy), 0).w);
}
