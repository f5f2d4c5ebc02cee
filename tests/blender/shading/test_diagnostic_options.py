# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What diagnostic views are asked for, and the legends that explain their colors."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.diagnostics.colors import DiagnosticOptions, legend_of, ramp_colors, rounded_up
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.renderer.device.overlays import matrices_of_pixels
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture
from curvrefl.curvrefl_addon.renderer.shading.diagnostic_legend import draw_layout, layout
from shading.mirror_ball import COLORS, PLAIN

pytestmark = pytest.mark.usefixtures("gpu")


def test_ramp_goes_through_its_stops_ever_lighter() -> None:
    ramp = ramp_colors(COLORS.ramp, 257)
    np.testing.assert_allclose(ramp[::64], np.array(COLORS.ramp), atol=1e-5)
    lightness = np.cbrt(ramp @ np.array([0.2126, 0.7152, 0.0722]))
    assert (np.diff(lightness) > 0).all()


def test_axes_are_at_right_angles() -> None:
    for axis in ((0.0, 0.0, 2.0), (1.0, 2.0, 3.0), (0.0, -0.001, -1.0)):
        axes = DiagnosticOptions(axis=axis).axes
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
        np.testing.assert_allclose(axes[0], unit(np.array(axis)))


@pytest.mark.parametrize(
    "wrong",
    [
        {"iterations": (5.0, 5.0)},
        {"angles": (0.0, 1.0)},
        {"angles": (2.0, 1.0)},
        {"stripes": 0},
        {"lines": 0},
        {"line_width": 0.0},
        {"axis": (0.0, 0.0, 0.0)},
        {"axis": (np.nan, 0.0, 1.0)},
        {"softness": -0.1},
        {"transparency": 1.1},
        {"curvature_range": -1.0},
        {"curvature_range": np.nan},
        {"curvature": "PRINCIPAL"},
        {"lock": "CAMERA"},
    ],
)
def test_options_out_of_range(wrong: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        DiagnosticOptions(**wrong)


def test_legends_say_what_the_colors_mean() -> None:
    angles = legend_of("ANGLE_ERROR", COLORS, PLAIN)
    assert angles is not None
    assert [label for _, label in angles.ticks] == ["0.01°", "0.1°", "1°", "10°"]
    np.testing.assert_allclose([place for place, _ in angles.ticks], [0, 1 / 3, 2 / 3, 1], atol=1e-12)
    iterations = legend_of("ITERATIONS", COLORS, DiagnosticOptions(iterations=(0.0, 8.0)))
    assert iterations is not None
    assert [label for _, label in iterations.ticks] == ["0", "2", "4", "6", "8+"]
    found = legend_of("STATUS", COLORS, PLAIN)
    assert found is not None
    assert found.swatches[2] == (COLORS.failed, "Not Found")
    used = legend_of("METHOD", COLORS, PLAIN, ("environment_cube", "environment_cube"))
    assert used is not None
    assert [label for _, label in used.swatches] == ["Environment Cube", "Background"]
    for pattern in ("ZEBRA", "LINES", "ISOPHOTES", "HIGHLIGHTS"):
        assert legend_of(pattern, COLORS, PLAIN) is None


def test_legend_of_curvature() -> None:
    mean = legend_of("CURVATURE", COLORS, PLAIN, curvature_end=1.5)
    assert mean is not None
    assert mean.title == "Mean Curvature, 1/m"
    assert mean.ticks[0] == (0.0, "-1.5") and mean.ticks[2] == (0.5, "0") and mean.ticks[4] == (1.0, "1.5")
    assert mean.ramp == COLORS.two_sided
    strongest = legend_of("CURVATURE", COLORS, DiagnosticOptions(curvature="STRONGEST"), curvature_end=2.0)
    gaussian = legend_of("CURVATURE", COLORS, DiagnosticOptions(curvature="GAUSSIAN"))
    assert strongest is not None and gaussian is not None
    assert strongest.ticks[0] == (0.0, "0") and strongest.ramp == COLORS.ramp
    assert gaussian.title == "Gaussian Curvature, 1/m²"


def test_ranges_end_at_numbers_that_read_well() -> None:
    assert [rounded_up(value) for value in (0.0, 1.0, 1.01, 0.00021, 7.0, 81.0, 1e-30)] == pytest.approx(
        [1.0, 1.0, 1.5, 0.0003, 8.0, 100.0, 1e-30]
    )


def test_legend_is_drawn_in_the_corner() -> None:
    import gpu

    width, height = 400, 160
    legend = legend_of("STATUS", COLORS, PLAIN)
    assert legend is not None
    placed = layout(legend, width - 30.0, 20.0, 1.0)
    x, y, w, h = placed.panel
    assert x > 0 and x + w == pytest.approx(width - 46.0)
    assert y == pytest.approx(36.0) and y + h < height
    offscreen = gpu.types.GPUOffScreen(width, height, format="RGBA32F")
    with offscreen.bind():
        gpu.state.active_framebuffer_get().clear(color=(0.0, 0.0, 0.0, 0.0))
        with matrices_of_pixels(width, height):
            draw_layout(placed)
    assert gpu.state.blend_get() == "NONE"
    picture = read_texture(offscreen.texture_color)
    outside = np.ones((height, width), bool)
    outside[int(y) : int(y + h) + 1, int(x) : int(x + w) + 1] = False
    assert (picture[outside] == 0.0).all()
    for (left, low, wide, high), color in placed.colors:
        shown = picture[int(low + high / 2), int(left + wide / 2), :3]
        linear = np.where(shown > 0.04045, ((shown + 0.055) / 1.055) ** 2.4, shown / 12.92)
        np.testing.assert_allclose(linear, color, atol=5e-3)
    text = picture[int(y) : int(y + h), int(x + 30) : int(x + w), :3]
    assert (text.min(-1) > 0.6).sum() > 50, "there are letters"
    offscreen.free()
