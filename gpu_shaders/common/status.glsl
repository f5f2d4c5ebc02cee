// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// How the search for a reflection point may end.
#from optics.status import REFLECTED, HIDDEN, UNSOLVED, INVALID
