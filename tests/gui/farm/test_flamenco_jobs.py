# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands that the job type for Flamenco makes, as two workers run them in a full Blender with the extension."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
from flamenco.manager import compile_job
from window import SECONDS
from window_blender import WindowBlender

pytestmark = pytest.mark.usefixtures("gpu")


def test_a_job_ends_with_its_report(window_blender: WindowBlender, installed: dict[str, str], tmp_path: Path) -> None:
    import bpy
    from small_scene import saved

    def rising(ball: bpy.types.Object) -> None:
        for frame in (1, 3):
            ball.location.z = 0.1 * frame
            ball.keyframe_insert("location", frame=frame)

    folder = tmp_path / "of a shot"
    folder.mkdir()
    output = folder / "the report"
    settings = {"frames": "1-3", "chunk_size": 2, "reflectors": "Mirror Ball", "methods": "exact", "peers": "none"}
    size = {"samples": 1, "resolution": "24x18"}
    of_paths = {"output": str(output), "blendfile": str(saved(folder, rising))}
    *chunks, merge = compile_job(settings | size | of_paths)["tasks"]

    def start(task: dict[str, object]) -> subprocess.Popen[str]:
        (command,) = task["commands"]  # type: ignore[misc]
        assert command["exe"] == "{blender}"
        # (What a Manager's variable of that name stands for.)
        line = [*window_blender.headless, *command["args"]]
        return subprocess.Popen(line, env=installed, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    workers = [start(task) for task in chunks]
    for worker in (*workers, None):
        process = start(merge) if worker is None else worker
        printed, _ = process.communicate(timeout=SECONDS)
        assert process.returncode == 0, printed[-3000:]
    assert len(workers) == 2
    report = json.loads((output / "report.json").read_text(encoding="utf-8"))
    assert report["range"] == {"first": 1, "last": 3, "step": 1, "count": 3}
    assert [entry["frame"] for entry in report["frames"]] == [1, 2, 3]
    assert report["methods"]["exact"]["pop"]["worst"] < 0.05
