# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers of paths (temporary)."""

import random

from ..device.shaders import Piece

SAMPLER = Piece(constants={"path_point": "IVEC4"})


def path_point(sub_frame: int, bounce: int) -> tuple[int, int, int, int]:
    g = random.Random(sub_frame * 1000 + bounce)
    return (g.getrandbits(31), g.getrandbits(31), g.getrandbits(31), 0)
