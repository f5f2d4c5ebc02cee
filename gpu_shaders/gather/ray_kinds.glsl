// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a ray for light between surfaces was: w of `gather_weight` and `gather_light`.
#define RAY_NONE 0.0
#define RAY_OFF_BASE 1.0
#define RAY_OFF_LOBE 2.0
#define RAY_TO_EMITTER 3.0  // its own light alone counts
#define RAY_WITHOUT_LIGHT 4.0
#define RAY_SHADOWED 5.0  // it met something before the place that shines
#define RAY_THROUGH 6.0  // through the base to the other side
