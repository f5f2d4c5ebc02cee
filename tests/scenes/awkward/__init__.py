# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that are awkward as artists' files are: see `registry`; tests/awkward/judge.py tries them."""

from .light import lamps, visibility, worlds
from .registry import SCENES, Awkward
from .settings import cameras, detail, display
from .surfaces import images, materials, mirrors
from .things import instances, kinds, numbers, shapes

SETTINGS = (display, detail, cameras)
SURFACES = (materials, images, mirrors)
LIGHT = (lamps, visibility, worlds)
THINGS = (shapes, kinds, instances, numbers)
TOPICS = (*SETTINGS, *SURFACES, *LIGHT, *THINGS)

__all__ = ["SCENES", "TOPICS", "Awkward"]
