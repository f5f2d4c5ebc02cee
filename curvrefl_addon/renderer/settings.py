# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How to render."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import InputError
from ..optics.catalogue import METHODS


@dataclass(frozen=True, slots=True)
class Settings:
    """What a renderer is asked for."""

    method: str = "secant_star"
    """A name of `optics.catalogue.METHODS`"""
    samples: int = 2
    """Jittered sub-frames of an anti-aliased picture; 1: pixel centres only, 16: a still"""
    pixel_tolerance: float = 0.5
    """Largest error of a reflected chord in pixels; the solver goes to a tenth of it"""
    map_resolution: int = 128
    """Texels along an edge of the reflector's radial cube map"""
    environment_resolution: int = 512
    """Texels along an edge of environment maps: of a cube's faces, of a sphere map's square"""
    steps: int = 0
    """Of methods with a fixed number of search steps; 0: the method's own"""
    grid_share: float = 0.1
    """Points of bounding grids that are solved, as a share of the vertices (`bisector_grid`)"""
    frustum: float = 1.25
    """Width of the view that is searched, in widths of the picture (`bisector_screen`)"""
    search_resolution: float = 1.0
    """Texels per pixel of the view that is searched (`bisector_screen`)"""
    shadow_rays: bool = False
    """What rays hit is shadowed by rays, not by depth maps (`exact`): sharp to the last pixel, for about the time of
    another walk for each lamp"""
    bounces: int = 4
    """Mirrors on the way of a ray (`exact`); what the last one shows of a mirror is its own light alone"""


def check_settings(settings: Settings) -> None:
    """Raise InputError for what is out of range."""
    if settings.method not in METHODS:
        raise InputError(f'There is no method "{settings.method}": choose one of {", ".join(METHODS)}.')
    if not 1 <= settings.samples <= 1024:
        raise InputError(f"{settings.samples} samples are out of range: choose 1 to 1024.")
    if not 0.01 <= settings.pixel_tolerance <= 100.0:
        raise InputError(f"A tolerance of {settings.pixel_tolerance} pixels is out of range: choose 0.01 to 100.")
    if not 8 <= settings.map_resolution <= 2048:
        raise InputError(f"A map of {settings.map_resolution} texels is out of range: choose 8 to 2048.")
    if not 8 <= settings.environment_resolution <= 4096:
        raise InputError(
            f"An environment map of {settings.environment_resolution} texels is out of range: choose 8 to 4096."
        )
    if not 1 <= settings.bounces <= 64:
        raise InputError(f"{settings.bounces} bounces are out of range: choose 1 to 64.")
    if not 0 <= settings.steps <= 1000:
        raise InputError(f"{settings.steps} search steps are out of range: choose 0 (the method's own) to 1000.")
    if not 0.0 < settings.grid_share <= 1.0:
        raise InputError(f"A grid share of {settings.grid_share} is out of range: choose more than 0, at most 1.")
    if not 1.0 <= settings.frustum <= 4.0:
        raise InputError(f"A frustum factor of {settings.frustum} is out of range: choose 1 to 4.")
    if not 0.1 <= settings.search_resolution <= 4.0:
        raise InputError(
            f"A search resolution of {settings.search_resolution} texels per pixel is out of range: choose 0.1 to 4."
        )
