# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that are awkward as artists' files are: see `registry`; tests/awkward/judge.py tries them."""

from .glass import numbers as glass_numbers
from .glass import shapes as glass_shapes
from .light import lamp_settings, lamps, visibility, worlds
from .registry import SCENES, Awkward
from .settings import cameras, detail, display
from .surfaces import coordinates, images, materials, mirrors, nodes, shaders
from .things import instances, kinds, modifiers, numbers, shapes

SETTINGS = (display, detail, cameras)
SURFACES = (materials, shaders, nodes, images, coordinates, mirrors)
GLASS = (glass_numbers, glass_shapes)
LIGHT = (lamps, lamp_settings, visibility, worlds)
THINGS = (shapes, modifiers, kinds, instances, numbers)
TOPICS = (*SETTINGS, *SURFACES, *GLASS, *LIGHT, *THINGS)

__all__ = ["SCENES", "TOPICS", "Awkward"]
