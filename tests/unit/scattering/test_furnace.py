# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""White surfaces in an evenly lit room cannot be told from it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.scattering.scatter import base_share, scatter
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays
from unit.scattering.surfaces import EAST, TABLE, UP, material, spread, viewer_at

WHITE = (1.0, 1.0, 1.0)
SURFACES = {
    "metal": material(base_color=WHITE, metallic=1.0),
    "glossy": material(base_color=WHITE, glossy_only=True),
    "half metal": material(base_color=WHITE, metallic=0.5),
    "lacquered metal": material(base_color=WHITE, metallic=1.0, coat_weight=1.0, coat_roughness=0.3),
    "lacquered plastic": material(base_color=WHITE, coat_weight=0.5, coat_roughness=0.1, coat_ior=1.8),
    "pane": material(base_color=WHITE, transmission=1.0, thin_wall=True),
    **{f"plastic {ior}": material(base_color=WHITE, ior=ior) for ior in (1.1, 1.5, 2.5, 8.0)},
    **{f"glass {ior}": material(base_color=WHITE, ior=ior, transmission=1.0) for ior in (0.6, 1.1, 1.5, 2.5, 20.0)},
}


def furnace(m: MaterialArrays, cosine: float, is_back: bool = False) -> float:
    """Mean radiance, in a room of radiance 1."""
    count = 1 << 13
    viewers = np.tile(viewer_at(cosine), (count, 1))
    s = scatter(m, UP, EAST, is_back, viewers, spread(count), TABLE)
    return float((s.weight.mean(axis=0) + base_share(m, is_back, viewers[:1, 2], TABLE)[0]).mean())


@pytest.mark.parametrize("name", list(SURFACES))
def test_white_furnace(name: str) -> None:
    for roughness in (0.0, 0.02, 0.2, 0.6, 1.0):
        for cosine in (0.9, 0.3):
            m = replace(SURFACES[name], roughness=roughness)
            sides = (False, True) if m.transmission else (False,)
            for is_back in sides:
                assert furnace(m, cosine, is_back) == pytest.approx(1.0, abs=5e-3), (roughness, cosine, is_back)


def test_colored_surfaces_lose_light() -> None:
    """The check above can fail: a metal of 0.8 scatters away more than it reflects once."""
    m = material(base_color=(0.8, 0.8, 0.8), metallic=1.0, roughness=1.0)
    assert 0.55 < furnace(m, 0.8) < 0.8
