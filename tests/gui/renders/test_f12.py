# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""F12 in a window, in a thread beside a viewport that draws, gives the pixels of `blender -b FILE -E CURVREFL -f 1`."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from window import SECONDS, Session, home, run_session
from window_blender import WindowBlender

SCRIPT = Path(__file__).resolve().parent / "f12_session.py"
WINDOW = (480, 360)
FRAMES = 4


@pytest.fixture(scope="module", params=["opengl", "vulkan"])
def rendered(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    window_blender: WindowBlender,
    archive: Path,
) -> Session:
    from small_scene import saved

    file, folder = saved(tmp_path_factory.mktemp("scene")), tmp_path_factory.mktemp(f"f12_{request.param}")
    session = run_session(window_blender, SCRIPT, folder, archive, file, folder, backend=request.param, size=WINDOW)
    assert not session.seen["error"], session.seen["error"] + session.printed[-3000:]
    installed = tmp_path_factory.mktemp("background")
    render = ("--background", "--gpu-backend", request.param, str(folder / "marked.blend"), "-E", "CURVREFL")
    for arguments in (
        ("--command", "extension", "install-file", "-r", "user_default", "--enable", str(archive)),
        (*render, "-o", str(folder / "background_####"), "-f", "1"),
    ):
        command = [*window_blender.headless, *arguments]
        result = subprocess.run(command, env=home(installed), capture_output=True, text=True, timeout=SECONDS)
        session.seen["background"] = result.stdout + result.stderr
        assert result.returncode == 0, session.seen["background"]
    session.seen["installed"] = str(installed)
    return session


def test_the_window_renders_what_the_background_does(rendered: Session) -> None:
    one = layers(rendered.folder / "background_0001.exr", rendered)
    assert {name.rpartition(".")[0] for name in one} == {
        f"ViewLayer.{name}" for name in ("Combined", "Mirror", "Object")
    }
    assert one["ViewLayer.Combined.R"].std() > 0.02 and one["ViewLayer.Mirror.A"].max() == 1.0
    for name in ("alone", "beside", "again"):
        other = layers(rendered.folder / f"{name}.exr", rendered)
        for channel, pixels in one.items():
            np.testing.assert_array_equal(other[channel], pixels, err_msg=f"{name}: {channel}")


def test_an_animation_renders_beside_the_viewport(rendered: Session) -> None:
    places = []
    for number in range(1, FRAMES + 1):
        cover = layers(rendered.folder / f"frame_{number:04d}.exr", rendered)["ViewLayer.Mirror.A"]
        places.append((cover * np.arange(cover.shape[1])).sum() / cover.sum())
    assert (np.diff(places) > 1.0).all()
    # A still of where the mirror has gone since the still before
    last = layers(rendered.folder / "last.exr", rendered)
    for channel, pixels in layers(rendered.folder / f"frame_{FRAMES:04d}.exr", rendered).items():
        np.testing.assert_array_equal(last[channel], pixels, err_msg=channel)


def test_the_viewport_goes_on(rendered: Session) -> None:
    seen: dict[str, Any] = rendered.seen
    assert seen["ended"] == ["complete"] * 5
    assert not any(seen["threads"]), "renders run in a thread of their own"
    assert seen["drawn during frame_"] > 0
    assert seen["messages"] == [] and seen["enabled"]
    assert seen["sessions"] == 0
    for printed in (rendered.printed, seen["background"]):
        assert "Traceback" not in printed and "Error" not in printed.replace("EGL Error", "")


@pytest.mark.parametrize(("problem", "said"), [("panorama", "is panoramic"), ("driver", "no OpenGL 4.3 context")])
def test_what_cannot_be_rendered_ends_with_a_sentence(
    rendered: Session, window_blender: WindowBlender, tmp_path: Path, problem: str, said: str
) -> None:
    change = 'import bpy; bpy.context.scene.camera.data.type = "PANO"' if problem == "panorama" else ""
    missing = {} if problem == "panorama" else {"__EGL_VENDOR_LIBRARY_FILENAMES": str(tmp_path / "none.json")}
    command = [
        *window_blender.headless,
        *("--background", str(rendered.folder / "marked.blend"), "-E", "CURVREFL", "--python-expr", change),
        *("-o", str(tmp_path / "picture_"), "-f", "1"),
    ]
    installed = home(Path(rendered.seen["installed"]))
    result = subprocess.run(command, env={**installed, **missing}, capture_output=True, text=True, timeout=SECONDS)
    assert result.returncode == 1
    assert (result.stdout + result.stderr).count(said) == 1
    assert not list(tmp_path.iterdir())


def layers(path: Path, session: Session) -> dict[str, np.ndarray]:
    from rendered import channels

    assert path.is_file(), session.printed[-3000:]
    return channels(path)
