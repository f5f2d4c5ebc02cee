# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the texels of shadow maps are too large for a view."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.renderer.lighting.coarse_shadows import Coarseness, are_too_coarse, things_ahead
from curvrefl.curvrefl_addon.renderer.lighting.shadow_views import ShadowView
from curvrefl.curvrefl_addon.scene.camera.view import View

RESOLUTION = 100
LIMIT = Coarseness(4.0, 0.1)
AHEAD = np.array([[0.0, 0.0, -8.0]])
RADIUS = np.array([1.0])


def eye(orthographic: bool = False) -> View:
    """At the origin, along -Z; 100 x 100 pixels, 100 pixels a radian, or 10 a meter."""
    if orthographic:
        return View(np.eye(4), np.diag([0.2, 0.2, -0.01, 1.0]), 100, 100)
    clip = np.array([[2.0, 0, 0, 0], [0, 2.0, 0, 0], [0, 0, -1.0, -0.2], [0, 0, -1.0, 0]])
    return View(np.eye(4), clip, 100, 100)


def sun(texel: float) -> ShadowView:
    """A map from above whose texels have this size, in meters."""
    matrix = np.diag([2.0 / (texel * RESOLUTION), 2.0 / (texel * RESOLUTION), -0.01, 1.0])
    return ShadowView(matrix, False, texel)


def is_coarse(
    shadow: ShadowView, centers: np.ndarray = AHEAD, radii: np.ndarray = RADIUS, view: View | None = None
) -> bool:
    return are_too_coarse([shadow], RESOLUTION, LIMIT, things_ahead(view or eye(), centers, radii))


def test_both_limits_have_to_be_passed() -> None:
    # At 7 m, the near side of the ball, a pixel is 0.07 m.
    assert is_coarse(sun(0.29))
    assert not is_coarse(sun(0.27))
    # The same distance, but the texel is less than a tenth of the object.
    assert not is_coarse(sun(0.29), centers=np.array([[0.0, 0.0, -10.0]]), radii=np.array([3.0]))


def test_only_what_is_before_the_eye_counts() -> None:
    for place in ((0.0, 0.0, 8.0), (20.0, 0.0, -8.0), (0.0, 0.0, -0.5)):
        assert not is_coarse(sun(5.0), centers=np.array([place]))
    assert is_coarse(sun(5.0), centers=np.array([[4.5, 0.0, -7.0]]))
    # It would have to be 25 pixels across.
    assert is_coarse(sun(5.0), centers=np.array([[0.0, 0.0, -8.0]]))
    assert not is_coarse(sun(5.0), centers=np.array([[0.0, 0.0, -10.0]]))
    assert not are_too_coarse([], RESOLUTION, LIMIT, things_ahead(eye(), AHEAD, RADIUS))


def test_texels_of_a_lamp_grow_with_the_distance_from_it() -> None:
    """Slopes of 0.02 a texel; a pixel of the orthographic eye is 0.1 m everywhere."""
    from_above = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, -25.0], [0, 0, 0, 1]], np.float64)
    clip = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, -1.0, -0.1], [0, 0, -1.0, 0]])
    lamp = ShadowView(clip @ from_above, True, 0.02)
    wide = np.array([1.5])
    assert is_coarse(lamp, radii=wide, view=eye(orthographic=True))
    assert not is_coarse(lamp, centers=np.array([[0.0, 5.5, -10.0]]), radii=wide, view=eye(orthographic=True))
