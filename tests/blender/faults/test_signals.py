# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Signals while Blender starts, reads and renders: through the launcher, and where nobody supervises."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import bpy
import pytest
from nightly.stop_verbs import SIGNALS, stop
from small_scene import saved

ROOT = Path(__file__).resolve().parents[3]
pytestmark = [
    pytest.mark.usefixtures("gpu"),
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="signals and /proc of Linux"),
]


@pytest.mark.skipif(bool(bpy.app.binary_path), reason="the launcher runs the wheel")
@pytest.mark.parametrize(("moment", "to_all"), [(0.2, False), (0.7, True), (1.5, False), (3.0, True)])
def test_a_verb_is_stopped(moment: float, to_all: bool, tmp_path: Path) -> None:
    if not (ROOT / ".venv" / "curvrefl-installed.txt").is_file():
        pytest.skip("the launcher would set itself up first")
    given = ["render", str(saved(tmp_path)), "--reflector", "Mirror Ball", "--samples", "256"]
    number = SIGNALS[int(10 * moment) % 3]
    folder = tmp_path / "run"
    folder.mkdir()
    stopped = stop([*given, "--resolution", "1000x800"], number, moment, folder, to_all)
    assert stopped is not None and stopped.answers(number), stopped


ALONE = """
import hashlib, sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import bootstrap
bootstrap.load_package()
from curvrefl.curvrefl_addon.command import cli, verbs
from curvrefl.curvrefl_addon.output import folder_to_publish

def busy(options):
    with folder_to_publish(Path(options.output)) as folder:
        (folder / "x.zip").write_text("half")
        Path(sys.argv[2]).touch()
        if sys.argv[3] == "deaf":
            # In C, as Blender is in a render: no handler of Python's runs.
            hashlib.pbkdf2_hmac("sha256", b"", b"", 2_000_000_000)
        while True:
            pass

verbs.build = busy
sys.exit(cli.main(["build", "--output", sys.argv[4]]))
"""


@pytest.mark.parametrize("kind", ["heard", "deaf"])
@pytest.mark.parametrize("number", SIGNALS)
def test_without_a_supervisor(kind: str, number: signal.Signals, tmp_path: Path) -> None:
    sign = tmp_path / "sign"
    process = subprocess.Popen(
        [sys.executable, "-c", ALONE, str(ROOT / "tools"), str(sign), kind, str(tmp_path / "new" / "out")],
        env={name: value for name, value in os.environ.items() if name != "CURVREFL_RUN"},
        stderr=subprocess.PIPE,
        text=True,
    )
    while not sign.exists():
        assert process.poll() is None
        time.sleep(0.01)
    process.send_signal(number)
    _, err = process.communicate(timeout=60)
    said = f"curvrefl: stopped by {number.name}; nothing is half-written.\n"
    assert (process.returncode, err) == (128 + number, said)
    assert [path.name for path in tmp_path.iterdir()] == ["sign"]
