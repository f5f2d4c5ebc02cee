# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of paths, judged against Cycles: see `registry`; tools/measure/paths/measure_paths.py measures them."""

from . import alpha, furnace, glass, layers, metals
from .registry import SCENES, PathScene

TOPICS = (metals, layers, glass, alpha, furnace)

__all__ = ["SCENES", "TOPICS", "PathScene"]
