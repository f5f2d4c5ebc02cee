# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces of a comparison over frames: by two workers of a farm, of which one is killed; and what `chunk` refuses."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import bpy
import pytest
from curvrefl.curvrefl_addon.command import cli
from farm import farm_tools, workers
from small_scene import saved

BALL = ("--reflector", "Mirror Ball")
FRAMES = range(1, 6)
ASKED = ("--method", "exact", "--samples", "1", "--peers", "cycles1", "--resolution", "24x18", "--sub-frames", "1")


def rising(ball: bpy.types.Object) -> None:
    """Half the ball's size in all."""
    for frame in (FRAMES[0], FRAMES[-1]):
        ball.location.z = 0.1 * frame
        ball.keyframe_insert("location", frame=frame)


@pytest.fixture(scope="module")
def programs() -> Path:
    if not sys.platform.startswith("linux") or bpy.app.binary_path:
        pytest.skip("the launcher runs the wheel, and processes are found in /proc")
    if not (workers.ROOT / ".venv" / "curvrefl-installed.txt").is_file():
        pytest.skip("the launcher would set itself up first")
    try:
        return farm_tools.find_or_make()
    except farm_tools.NoFarmToolsError as error:
        pytest.skip(f"no tools of render farms: {error}")


@pytest.mark.usefixtures("gpu")
def test_a_farm_with_a_worker_killed_makes_the_report_of_one_machine(programs: Path, tmp_path: Path) -> None:
    file, frames = saved(tmp_path, rising), f"{FRAMES[0]}-{FRAMES[-1]}"
    given = [str(file), *BALL, *ASKED, "--frames", frames]
    studio, bundle, farmed, alone = (tmp_path / name for name in ("studio", "a bundle", "of farm", "alone"))
    made = ["--frames-per-task", "3", "--program", str(workers.LAUNCHER), "--report", str(farmed)]
    assert cli.main(["farm", "openjd", *given, *made, "--output", str(bundle)]) == 0
    check = subprocess.run([programs / "openjd", "check", bundle / "template.yaml"], capture_output=True, text=True)
    assert check.returncode == 0, check.stdout + check.stderr
    # What it is submitted with is another machine's, from which workers map it.
    rules = [{"source_path_format": "POSIX", "source_path": str(studio), "destination_path": str(tmp_path)}]
    values = {"File": str(studio / file.relative_to(tmp_path)), "Output": str(studio / farmed.name)}
    (tmp_path / "tmp").mkdir()
    farm = workers.Farm(programs, bundle, values, rules, tmp_path / "tmp")
    killed: list[workers.Run] = []

    def is_killed(run: workers.Run) -> bool:
        """The first worker that comes to the reference of its second frame."""
        if not killed and len(run.frames) == 2 and f"Frame {run.frames[1]}: Rendering the reference" in run.status:
            killed.append(run)
        return killed[:1] == [run]

    runs = farm.run(is_killed)
    assert cli.main(["compare", *given, "--output", str(alone)]) == 0
    assert sorted(run.ended for run in runs) == ["done"] * 3 + ["killed"], [run.lines[-5:] for run in runs]
    again = next(run for run in runs if run.task == killed[0].task and run is not killed[0])
    assert again.worker != killed[0].worker
    assert any(re.match("1 of [23] frames are there already", line) for line in again.lines)
    assert workers.done_once(runs, FRAMES)
    assert workers.different(farmed, alone) == []
    assert {path.name for path in farmed.iterdir()} == {path.name for path in alone.iterdir()}, "nothing is left over"
    # A farm is told how far a task is.
    whole = next(run for run in runs if run.step == "Compare" and run.task != killed[0].task)
    progress = [item["progress"] for item in whole.told if item.get("progress") is not None]
    count = len(whole.frames)
    assert progress == sorted(progress) and count > 1
    assert {round(100.0 * number / count, 1) for number in range(count + 1)} <= set(progress)
    assert any((item.get("status") or "").startswith(f"Frame {whole.frames[1]}: Rendering") for item in whole.told)


def test_what_a_chunk_refuses(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    given = ["chunk", "/nowhere/a.blend", *BALL, "--output", str(tmp_path / "out")]
    for more, said in (
        ((), "--frames"),
        (("--frames", "2-1"), "the last comes after the first"),
        (("--frames", "1,2,4"), "as far apart"),
        (("--frames", "1-3", "--of", "1-9:2"), "Frame 2 of --frames"),
        (("--frames", "1-3", "--resume"), "--resume"),
    ):
        assert cli.main([*given, *more]) == 2
        assert said in capfd.readouterr().err
    assert cli.main([*given, "--frames", "1-3", "--progress", "openjd"]) == 2
    out, err = capfd.readouterr()
    assert out.startswith('openjd_fail: There is no file "/nowhere/a.blend"') and out[len("openjd_fail: ") :] in err
    assert not (tmp_path / "out").exists()


def test_frames_as_farms_write_them() -> None:
    from curvrefl.curvrefl_addon.command.arguments import frames_of

    assert frames_of("9,10") == range(9, 11) and frames_of("1,3-5:2,7") == range(1, 8, 2)
    assert frames_of("7-7") == range(7, 8) and frames_of("4, 4") == range(4, 5)
