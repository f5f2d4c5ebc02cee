# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All animations by name; `tools/make_scenes.py` writes them as .blend files."""

from __future__ import annotations

from curvrefl.curvrefl_addon.demo.kettle import KETTLE

from . import ants, chairs, city, hand, kitchen
from .stage import Animation

ANIMATIONS = {
    "kitchen": Animation(
        kitchen.build, (kitchen.POT,), 15005, "Estalella et al. 2005, 2006: a kitchen, and a flight to a bowl of metal"
    ),
    "city": Animation(city.build, (city.SAUCER,), 82085, "Estalella et al. 2006: a saucer lands on a city's square"),
    "ants": Animation(ants.build, ants.EYES, 30004, "Estalella et al. 2006: the eyes of four ants among cans"),
    "hand": Animation(
        hand.build,
        (KETTLE,),
        23812,
        "Roger and Holzschuch 2006, figures 1 and 8: a hand and the handle of a kettle",
    ),
    "chairs": Animation(
        chairs.build,
        (chairs.BALL,),
        9294,
        "Roger and Holzschuch 2006, figure 9: the back of a chair close to a mirror",
    ),
}
