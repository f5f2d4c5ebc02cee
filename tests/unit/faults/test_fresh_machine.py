# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The launcher on a machine without CPython 3.13: uv gets one, or pip gets uv first; else a sentence. And its signals.

uv and what it downloads are stubs; so is pip's package of it.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
TOOLS = (
    "sh",
    "dirname",
    "readlink",
    "cat",
    "cmp",
    "mkdir",
    "rm",
    "env",
    "sleep",
    "chmod",
    "touch",
    "ln",
    "mktemp",
    "xargs",
)

pytestmark = pytest.mark.skipif(sys.version_info[:2] != (3, 13), reason="stands for the CPython 3.13 that uv gets")

UV = f"""#!/bin/sh
[ "$1" = --version ] && exit 0
[ "$1 $2" = "python find" ] && exit 2
echo "$@ into $UV_PYTHON_INSTALL_DIR" >>"$UV_LOG"
[ -z "${{UV_HANGS:-}}" ] || {{ touch "$UV_HANGS"; exec sleep 100; }}
[ -z "${{UV_FAILS:-}}" ] || {{ echo "error: no network" >&2; exit 1; }}
mkdir -p "$UV_PYTHON_INSTALL_DIR/cpython-3.13.9-linux/bin"
ln -s {sys.executable} "$UV_PYTHON_INSTALL_DIR/cpython-3.13.9-linux/bin/python3.13"
"""
# Another Python than 3.13, which has pip: it "installs" uv.
OLDER = """#!/bin/sh
case "$*" in
    *version_info*3,\\ 8*) exit 0 ;;
    *implementation*) echo cpython 3 11 ;;
    *pip\\ install*)
        while [ "$1" != --target ]; do shift; done
        mkdir -p "$2/bin" && cat "$UV_STUB" >"$2/bin/uv" && chmod +x "$2/bin/uv" ;;
    *) exit 9 ;;
esac
"""


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    """The launcher with a set-up that is done at once, on a path with a shell's tools alone."""
    root = tmp_path / "a copy"
    (root / "tools").mkdir(parents=True)
    shutil.copy2(ROOT / "curvrefl", root)
    shutil.copy2(ROOT / "tools" / "supervise.py", root / "tools")
    (root / "curvrefl_addon").mkdir()
    shutil.copy2(ROOT / "curvrefl_addon" / "held_folders.py", root / "curvrefl_addon")
    (root / "tools" / "set_up.py").write_text(
        "import os, pathlib, sys\n"
        "venv = pathlib.Path(__file__).parent.parent / '.venv/bin'\n"
        "venv.mkdir(parents=True)\n"
        "os.symlink(sys.executable, venv / 'python')\n"
        "(venv.parent / 'curvrefl-installed.txt').touch()\n"
    )
    (root / "tools" / "run_verb.py").write_text("import sys\nprint(*sys.argv[1:])\nsys.exit(7)\n")
    for name in ("requirements.txt", "requirements-dev.txt"):
        (root / name).write_text("")
    tools = tmp_path / "bin"
    tools.mkdir()
    for name in TOOLS:
        found = shutil.which(name)
        assert found, f"this system has no {name}"
        (tools / name).symlink_to(found)
    (tmp_path / "uv").write_text(UV)
    return root


def add(machine: Path, name: str, script: str) -> None:
    program = machine.parent / "bin" / name
    program.write_text(script)
    program.chmod(0o755)


def start(machine: Path, **more: str) -> subprocess.Popen[str]:
    environment = {
        "PATH": str(machine.parent / "bin"),
        "HOME": str(machine.parent),
        "UV_LOG": str(machine.parent / "log"),
        "UV_STUB": str(machine.parent / "uv"),
    }
    return subprocess.Popen(
        [str(machine / "curvrefl"), "demo", "x y"],
        env=environment | more,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def call(machine: Path, **more: str) -> tuple[int, str, str]:
    process = start(machine, **more)
    out, err = process.communicate(timeout=120)
    return process.returncode, out, err


def test_uv_that_is_there_gets_it(machine: Path) -> None:
    add(machine, "uv", UV)
    code, out, err = call(machine)
    assert (code, out, err.count("\n")) == (7, "-- demo x y\n", 1)
    assert "getting CPython 3.13" in err and err.endswith("done\n")
    log = (machine.parent / "log").read_text()
    assert "python install" in log and f"into {machine}/.python/python" in log
    # It is found again where the environment has to be made anew.
    shutil.rmtree(machine / ".venv")
    assert call(machine) == (7, "-- demo x y\n", "")
    assert (machine.parent / "log").read_text() == log


def test_pip_of_any_python_gets_uv(machine: Path) -> None:
    add(machine, "python3", OLDER)
    code, out, err = call(machine)
    assert (code, out, err.count("\n")) == (7, "-- demo x y\n", 1), (machine / ".python" / "log").read_text()
    assert (machine / ".python" / "uv" / "bin" / "uv").exists()


def test_without_a_network_it_says_what_to_install(machine: Path) -> None:
    add(machine, "uv", UV)
    code, out, err = call(machine, UV_FAILS="1")
    assert (code, out, err.count("\n")) == (2, "", 2)
    assert "install CPython 3.13" in err and "BLENDER" in err
    assert "no network" in (machine / ".python" / "log").read_text()
    # The next start tries again.
    assert call(machine)[0] == 7


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_while_it_is_got_leaves_nothing(number: signal.Signals, machine: Path) -> None:
    add(machine, "uv", UV)
    hangs = machine.parent / "hangs"
    process = start(machine, UV_HANGS=str(hangs))
    for _ in range(3000):
        if hangs.exists():
            break
        time.sleep(0.01)
    process.send_signal(number)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 128 + number
    assert f"stopped by {number.name}" in err
    assert not (machine / ".python").exists()


def test_signals_reach_a_blender_without_any_python(machine: Path) -> None:
    """Where there is no Python to supervise it the launcher itself does what a shell can."""
    sign, half = machine.parent / "sign", machine.parent / "half"
    add(
        machine,
        "blender",
        f"#!/bin/sh\ntrap '' TERM INT HUP\nmkdir '{half}'\nprintf '%s\\0' '{half}' >\"$CURVREFL_RUN/leftovers\"\n"
        f"touch '{sign}'\nwhile :; do sleep 0.1; done\n",
    )
    temporary = machine.parent / "tmp"
    temporary.mkdir()
    process = start(machine, BLENDER="blender", TMPDIR=str(temporary))
    for _ in range(3000):
        if sign.exists():
            break
        time.sleep(0.01)
    process.terminate()
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (143, "")
    assert err == "curvrefl: stopped by SIGTERM; nothing is half-written.\n"
    assert not half.exists()
    assert list(temporary.iterdir()) == []


def test_closed_streams(machine: Path) -> None:
    add(machine, "uv", UV)
    call(machine)
    environment = {"PATH": os.environ["PATH"]}
    for closed in ("<&-", ">&-", "2>&-"):
        result = subprocess.run(
            ["sh", "-c", f'"$0" demo {closed}', str(machine / "curvrefl")],
            env=environment,
            capture_output=True,
            text=True,
        )
        assert result.returncode == 7, (closed, result)
        assert result.stdout == ("" if closed == ">&-" else "-- demo\n")
        assert result.stderr == ""
