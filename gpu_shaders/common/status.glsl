// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The codes of curvrefl_addon/optics/status.py.
#define REFLECTED 0
#define HIDDEN 1
#define UNSOLVED 2
#define INVALID 3
