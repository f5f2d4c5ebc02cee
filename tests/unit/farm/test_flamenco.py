# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The job type for Flamenco 3: what a Manager makes of it, and what our strict one refuses."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from curvrefl.curvrefl_addon.command.arguments import frames_of
from curvrefl.curvrefl_addon.command.cli import _parser
from curvrefl.curvrefl_addon.farm.bundle import FLAMENCO_JOB_TYPE
from curvrefl.curvrefl_addon.settings_table import MOST_REFERENCE_SAMPLES
from flamenco.manager import RefusedError, compile_job

JOB: dict[str, Any] = {
    "frames": "1-24",
    "reflectors": "Mirror Ball,-Pot",
    "resolution": "640x480",
    "output": "/farm/a report",
    "blendfile": '/farm/shots/a "shot" $1.blend',
}


def parsed(command: dict[str, Any]) -> Any:
    assert (command["name"], command["exe"], command["args"][:2]) == ("exec", "{blender}", ["--command", "curvrefl"])
    return _parser().parse_args(command["args"][2:])


@pytest.mark.parametrize(
    ("frames", "size"), [("1-24", 8), ("1-24", 5), ("7", 8), ("3,4", 1), (" 5 .. 9 ", 2), ("1-9", 50)]
)
def test_each_frame_is_in_one_chunk(frames: str, size: int) -> None:
    *chunks, merge = compile_job(JOB | {"frames": frames, "chunk_size": size})["tasks"]
    asked = [parsed(command) for task in chunks for command in task["commands"]]
    done = [frame for options in asked for frame in options.frames]
    wanted = list(frames_of(frames.replace("..", "-").replace(" ", "")))
    assert sorted(done) == wanted and len(chunks) == len(asked) == -(-len(wanted) // size)
    assert all(options.frames.step == 1 for options in asked)
    assert {task["type"] for task in (*chunks, merge)} == {"blender"}
    assert sorted(merge["dependencies"]) == sorted(task["name"] for task in chunks)
    (command,) = merge["commands"]
    assert list(parsed(command).frames) == wanted and parsed(command).output == JOB["output"]


def test_settings_come_through_as_they_are() -> None:
    given = JOB | {"methods": "all", "peers": "none", "samples": 3, "light": "direct"}
    options = parsed(compile_job(given)["tasks"][0]["commands"][0])
    assert (options.file, options.output) == (JOB["blendfile"], JOB["output"])
    assert (options.reflector, options.resolution) == (JOB["reflectors"], (640, 480))
    assert (options.method, options.peers, options.samples, options.light) == ("all", "none", 3, "direct")


def test_defaults_are_those_of_the_verb() -> None:
    settings = {item["key"]: item for item in compile_job(JOB)["settings"]}
    options = _parser().parse_args(["compare", "a.blend", "--reflector", "A", "--output", "out"])
    found = [settings[name]["default"] for name in ("methods", "peers", "samples", "light")]
    assert found == [options.method, options.peers, options.samples, options.light]
    assert settings["samples"]["propargs"]["max"] == MOST_REFERENCE_SAMPLES


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"frames": "1-3,7"}, "without gaps"),
        ({"frames": "1,3"}, "without gaps"),
        ({"frames": ""}, "empty range"),
        ({"frames": "-3-5"}, "invalid range"),
        ({"chunk_size": 0}, "invalid chunk size"),
        ({"samples": "3"}, "samples is no int32"),
        ({"quality": 1}, "no setting quality"),
        ({"output": None}, "output is not given"),
    ],
)
def test_what_is_refused(change: dict[str, Any], said: str) -> None:
    with pytest.raises(RefusedError, match=said):
        compile_job({name: value for name, value in (JOB | change).items() if value is not None})


@pytest.mark.parametrize(
    ("part", "other", "said"),
    [
        ("author.Command(", "author.Commands(", "author has no Commands"),
        ("addDependency", "addDependencies", "a task has no addDependencies"),
        ("settings.light", "settings.lights", "settings has no lights"),
        ('"exec"', '"run"', "no command run"),
        ('"blender");', '"render");', "no type that workers take"),
        ('visible: "web"', 'visible: "sometimes"', "blendfile: sometimes"),
        ("job.addTask(merge)", "job.tasks.push(merge)", "the job has no tasks"),
        ("frameChunker(", "chunkFrames(", "chunkFrames is not defined"),
        ("exe:", "executable:", "a string exe"),
        ("        job.addTask(task);\n", "", "not in the job"),
    ],
)
def test_the_manager_is_strict(part: str, other: str, said: str, tmp_path: Path) -> None:
    source = FLAMENCO_JOB_TYPE.read_text(encoding="utf-8")
    assert part in source
    path = tmp_path / FLAMENCO_JOB_TYPE.name
    path.write_text(source.replace(part, other), encoding="utf-8")
    with pytest.raises(RefusedError, match=said):
        compile_job(JOB, path)
