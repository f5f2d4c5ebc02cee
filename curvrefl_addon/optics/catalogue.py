# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The methods by name: where each comes from and what it takes for granted."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Method:
    """One way to the picture of what a mirror reflects."""

    label: str
    source: str
    assumes: str
    """Of the reflector and the scene"""
    solves_vertices: bool
    """Whether there is a `gpu_shaders/<name>.comp.glsl`; else the mirror looks up an environment"""


METHODS: dict[str, Method] = {
    "secant_star": Method(
        "Secant Search",
        "Roger & Holzschuch 2006, section 3.3, with a safeguarded end",
        "every ray from the star center leaves the reflector once; one reflection per vertex",
        True,
    ),
    "environment_cube": Method(
        "Environment Cube",
        "Blinn & Newell 1976; six faces from the reflector's center",
        "everything is infinitely far away",
        False,
    ),
}
