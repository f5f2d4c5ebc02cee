# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where shadows are found by rays, one lamp in each of many sub-frames stands for all: the mean is that of all."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.lighting import lighting
from lighting.room import add_lamp, build_room, our_room

pytestmark = pytest.mark.usefixtures("gpu")


def room_with_lamps(count: int) -> None:
    """Hard lamps of other places and strengths each, so that shadows are the same in all sub-frames."""
    scene = build_room(with_lamp=False)
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    for number in range(count):
        angle = 2.4 * number
        place = (3.0 * np.cos(angle), 3.0 * np.sin(angle) - 1.0, 2.5 + 0.4 * number)
        add_lamp("POINT", place, 80.0 * 2.0**number, shadow_soft_size=0.0)
    add_lamp("SUN", (1.0, -2.0, 4.0), 0.5, angle=0.0)


def picture(samples: int, picks: bool, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    """(HEIGHT, WIDTH, 3), by shadow rays."""
    with monkeypatch.context() as change:
        change.setattr(lighting.Lighting, "too_coarse", lambda *_: (True, False))
        if not picks:
            change.setattr(lighting, "picks_lamp", lambda *_: False)
        return our_room(samples=samples)[0].astype(float)


def test_one_lamp_stands_for_all(monkeypatch: pytest.MonkeyPatch) -> None:
    room_with_lamps(3)
    picked, whole = picture(64, True, monkeypatch), picture(64, False, monkeypatch)
    assert picked.sum(axis=(0, 1)) == pytest.approx(whole.sum(axis=(0, 1)), rel=2e-3)
    off = np.abs(picked - whole).max(axis=-1)
    # Where no lamp is in shadow each stands for the others exactly; elsewhere its share of the sub-frames does.
    assert np.median(off) < 1e-4 * whole.mean()
    assert 0.02 < (off > 1e-3 * whole.mean()).mean() < 0.7
    # (Of steps of a golden section an interval has at most two too many, of 64.)
    assert np.sqrt((off**2).mean()) < 0.05 * whole.mean()


def test_few_sub_frames_have_the_shadows_of_all(monkeypatch: pytest.MonkeyPatch) -> None:
    room_with_lamps(3)
    assert np.array_equal(picture(4, True, monkeypatch), picture(4, False, monkeypatch))


def test_a_single_lamp_is_not_picked(monkeypatch: pytest.MonkeyPatch) -> None:
    room_with_lamps(0)
    assert np.array_equal(picture(16, True, monkeypatch), picture(16, False, monkeypatch))
