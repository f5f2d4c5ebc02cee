# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How the search for a reflection point may end; the shaders take these numbers from here (`status.glsl`)."""

from __future__ import annotations

REFLECTED = 0
HIDDEN = 1
UNSOLVED = 2
INVALID = 3

SENTENCES = {
    REFLECTED: "A reflection point was found; eye and vertex are on the outer side there.",
    HIDDEN: "The reflector hides the vertex from the eye or the vertex is inside it; it has no reflection.",
    UNSOLVED: "The search did not converge within its steps; the vertex is left out.",
    INVALID: "The vertex has no finite position, or one too far away to compute with; it is left out.",
}
