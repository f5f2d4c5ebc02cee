# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that are awkward as artists' files are: see `registry`; tests/awkward/judge.py tries them."""

from .light import lamps, visibility, worlds
from .registry import SCENES, Awkward
from .settings import cameras, detail, display
from .surfaces import images, materials, mirrors
from .things import instances, kinds, numbers, shapes

TOPICS = (
    display,
    detail,
    cameras,
    materials,
    images,
    mirrors,
    lamps,
    visibility,
    worlds,
    shapes,
    kinds,
    instances,
    numbers,
)

__all__ = ["SCENES", "TOPICS", "Awkward"]
