# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of many sub-frames: the same bits again, and their own estimate of what is left."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.diagnostics.colors import DiagnosticColors
from curvrefl.curvrefl_addon.renderer import exposure
from curvrefl.curvrefl_addon.renderer.noise import POWER_OF_ALL, SIGNS, Convergence, NoiseMeter
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from curvrefl.curvrefl_addon.report.display import display_transform
from curvrefl.curvrefl_addon.scene.camera.lens import Lens
from curvrefl.curvrefl_addon.settings_table import Settings
from curvrefl.curvrefl_addon.viewport.region import SETTLED_SECONDS, RegionPicture
from scenes.paths.soft_room import soft_room, soft_view

pytestmark = pytest.mark.usefixtures("gpu")

VIEW = soft_view(40, 30, Lens(0.1, 4.5))
TRUTH = 256
OPTIONS = SimpleNamespace(colors=DiagnosticColors())
SETTINGS: Any = SimpleNamespace(
    show="REFLECTION", motion_resolution="HALF", stripe_direction=(0.0, 0.0, 1.0), stripe_count=3
)


def drawn(samples: int, roughness: float = 0.0, **settings: Any) -> tuple[np.ndarray, Convergence]:
    """(h, w, 3) and how far it has come."""
    renderer = Renderer(soft_room(roughness), Settings(method="exact", samples=samples, **settings))
    frame = renderer.render(VIEW)
    renderer.free()
    assert frame.convergence is not None
    return frame.color()[..., :3], frame.convergence


def error(one: np.ndarray, other: np.ndarray) -> float:
    """Root mean square, as displayed."""
    return float(np.sqrt(((display_transform(one) - display_transform(other)) ** 2).mean()))


@pytest.mark.parametrize("roughness", [0.0, 0.4])
def test_the_estimate_is_of_the_size_of_the_error(roughness: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Soft shadows, the sky's, depth of field, edges; and paths off a rough mirror."""
    truth, _ = drawn(TRUTH, roughness)
    found: dict[int, tuple[float | None, float]] = {}

    class Watched(NoiseMeter):
        def look(self, done: int) -> None:
            super().look(done)
            picture = self._canvas.pixels()[..., :3] / (done * self._weight)
            found[done] = (self.convergence.noise, error(picture, truth))

    monkeypatch.setattr(exposure, "NoiseMeter", Watched)
    drawn(64, roughness)
    known = {count: found[count] for count in (8, 16, 32, 64)}
    drawn(16, roughness)
    known[-16] = found[16]
    for count, (noise, right) in known.items():
        assert noise is not None and 0.5 * right < noise < 2.0 * right, (count, known)


def test_a_limit_of_noise_ends_the_picture_and_keeps_its_light() -> None:
    whole, known = drawn(64)
    picture, convergence = drawn(64, noise_limit=4.0)
    assert convergence.done in (8, 16, 32) and convergence.noise is not None and convergence.noise < 0.04
    assert known.noise is not None and known.noise < convergence.noise
    np.testing.assert_allclose(picture.mean(axis=(0, 1)), whole.mean(axis=(0, 1)), rtol=0.02)
    assert str(convergence).startswith(f"{convergence.done} of 64, noise ")
    assert str(known).startswith("64, noise ")


def test_of_too_few_sub_frames_nothing_is_said() -> None:
    assert drawn(4)[1] == Convergence(4, 4, None) and str(drawn(4)[1]) == "4"


def test_a_picture_again_has_the_same_bits() -> None:
    """Also where shadow maps are drawn over others meanwhile."""
    renderer = Renderer(soft_room(0.3), Settings(method="exact", samples=40))
    first, again = (renderer.render(VIEW).color() for _ in range(2))
    renderer.free()
    np.testing.assert_array_equal(first, again)
    other = Renderer(soft_room(0.3), Settings(method="exact", samples=40))
    np.testing.assert_array_equal(first, other.render(VIEW).color())
    other.free()


def test_a_viewport_at_rest_has_the_same_bits_again_and_says_how_far_it_is() -> None:
    renderer = Renderer(soft_room(0.3), Settings(method="exact", samples=64))

    def rested(steps: int) -> RegionPicture:
        picture = RegionPicture(None, renderer)  # type: ignore[arg-type]
        for step in range(steps):
            picture.advance(VIEW, SETTINGS, OPTIONS, step * SETTLED_SECONDS, False, {})
            if step == 0:
                assert picture.is_coarse and not dict(picture.statistics()).get("Samples")
        return picture

    first, again = rested(80), rested(80)
    assert first.is_complete and not first.is_coarse
    np.testing.assert_array_equal(first.pixels(), again.pixels())
    assert dict(first.statistics())["Samples"].startswith("64, noise ")
    halfway = dict(rested(18).statistics())["Samples"]
    assert halfway.startswith("17 of 64, noise ")
    renderer.configure(Settings(method="exact", samples=64, noise_limit=5.0))
    ended = rested(80)
    assert ended.is_complete and dict(ended.statistics())["Samples"].split()[0] in ("8", "16", "32")
    renderer.free()


def test_what_was_added_is_found_by_its_halves() -> None:
    """Sub-frames of one color each: the halves' means are known."""
    for samples in (8, 12, 16, 32):
        values = np.random.default_rng(samples).random(samples)
        canvas = Canvas.of_size(4, 4)
        meter = NoiseMeter(canvas, samples, 1.0)
        for number, value in enumerate(values):
            with canvas.frame_buffer.bind():
                total = float(values[: number + 1].sum())
                canvas.frame_buffer.clear(color=(total, total, total, number + 1.0))
            assert value >= 0.0
            meter.look(number + 1)
        plus = np.array([sign == "+" for sign in SIGNS[:samples]])
        shown = display_transform(np.array([values.mean(), values.mean() - 0.5 * _gap(values, plus)]))
        found = meter.convergence.noise
        assert found == pytest.approx(abs(float(shown[0] - shown[1])) / np.sqrt(4.0**POWER_OF_ALL - 1.0), rel=1e-3)


def _gap(values: np.ndarray, plus: np.ndarray) -> float:
    return float(values[plus].mean() - values[~plus].mean())
