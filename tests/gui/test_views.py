# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is on screen is the mirrors' picture, in every shading mode, projection and region, on both backends."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from window import InWindow, Session

SCRIPT = Path(__file__).resolve().parent / "views_session.py"


@pytest.fixture(scope="module", params=["opengl", "vulkan"])
def session(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, in_window: InWindow) -> Session:
    from small_scene import saved

    folder = tmp_path_factory.mktemp(f"views_{request.param}")
    return in_window(SCRIPT, folder, saved(folder), folder, backend=request.param, size=(640, 480))


def test_session_comes_to_its_end(session: Session) -> None:
    assert not session.seen["error"], session.seen["error"]
    assert "Traceback" not in session.printed, session.printed[-3000:]
    assert session.seen["pictures when switched off"] == 0


@pytest.mark.parametrize("name", ["solid", "material", "rendered", "orthographic", "quad", "after_quad", "local"])
def test_screen_shows_the_pictures(session: Session, name: str) -> None:
    """Where a mirror covers a pixel whole, through the Standard view transform."""
    found = session.seen["captures"][name]
    assert len(found["regions"]) == (4 if name == "quad" else 1)
    screenshot = session.folder / f"{name}.png"
    if not screenshot.is_file():
        pytest.skip("no ImageMagick to take a picture of the window")
    import bpy
    from curvrefl.curvrefl_addon.report.display import display_transform

    image = bpy.data.images.load(str(screenshot))
    window = np.array(image.pixels, np.float32).reshape(image.size[1], image.size[0], 4)
    for number, (x, y, width, height) in enumerate(found["regions"]):
        picture = np.load(session.folder / f"{name}_{number}.npy")
        assert picture.shape[:2] == (height, width)
        covered = picture[..., 3] > 0.999
        assert covered.sum() > 200, f"no mirror in region {number}"
        difference = np.abs(window[y : y + height, x : x + width, :3] - display_transform(picture[..., :3]))[covered]
        assert np.median(difference) < 2 / 255
        assert np.percentile(difference, 95) < 8 / 255


def test_coarse_while_moving_and_fine_at_rest(session: Session) -> None:
    assert session.seen["coarse while moving"]
    assert session.seen["fine at rest"]


def test_every_window_has_its_own_picture_and_none_stays_behind(session: Session) -> None:
    assert session.seen["pictures in two windows"] == 2
    assert session.seen["pictures after closing one"] == 1
    assert session.seen["captures"]["after_quad"]["pictures"] == 1


def test_local_view_shows_the_mirror_alone(session: Session) -> None:
    everything, local = session.seen["local view"]
    assert everything > 1 == local
    assert session.seen["after local view"] == everything
