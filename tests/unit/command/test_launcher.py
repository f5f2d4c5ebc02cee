# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The launcher and the set-up, in a small copy of the repository whose packages are made here, without a network."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
SHELL_TOOLS = ("sh", "dirname", "readlink", "cat", "cmp")
PROGRESS = "setting up once"

needs_python_313 = pytest.mark.skipif(
    sys.version_info[:2] != (3, 13) or sys.platform == "win32",
    reason="the set-up makes its environment with CPython 3.13 on a POSIX system",
)


def make_wheel(folder: Path, name: str, version: str) -> None:
    """A package with one module that knows its version."""
    info = f"{name}-{version}.dist-info"
    files = {
        f"{name}.py": f"VERSION = '{version}'\n",
        f"{info}/METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n",
        f"{info}/WHEEL": "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    files[f"{info}/RECORD"] = "".join(f"{path},,\n" for path in (*files, f"{info}/RECORD"))
    with zipfile.ZipFile(folder / f"{name}-{version}-py3-none-any.whl", "w") as wheel:
        for path, text in files.items():
            wheel.writestr(path, text)


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """The launcher and its set-up with packages that stand for Blender and numpy, and a verb that prints itself."""
    root = tmp_path / "a copy"
    (root / "tools").mkdir(parents=True)
    shutil.copy2(ROOT / "curvrefl", root)
    for name in ("set_up.py", "supervise.py"):
        shutil.copy2(ROOT / "tools" / name, root / "tools")
    (root / "curvrefl_addon").mkdir()
    shutil.copy2(ROOT / "curvrefl_addon" / "held_folders.py", root / "curvrefl_addon")
    (root / "tools" / "run_verb.py").write_text("import bpy, sys\nprint(bpy.VERSION, *sys.argv[1:])\nsys.exit(7)\n")
    (root / "requirements.txt").write_text("# Blender\nbpy==1.0\n")
    (root / "requirements-dev.txt").write_text("numpy==1.0\n")
    wheels = tmp_path / "wheels"
    wheels.mkdir()
    for name, version in (("bpy", "1.0"), ("bpy", "2.0"), ("numpy", "1.0")):
        make_wheel(wheels, name, version)
    return root


def environment(repository: Path, **more: str) -> dict[str, str]:
    """Nothing but the tools that the launcher's shell needs, and packages from the folder of wheels."""
    tools = repository.parent / "bin"
    tools.mkdir(exist_ok=True)
    for name in SHELL_TOOLS:
        link = tools / name
        if not link.exists():
            found = shutil.which(name)
            assert found, f"this system has no {name}"
            link.symlink_to(found)
    return {
        "PATH": str(tools),
        "HOME": str(repository.parent),
        "PIP_NO_INDEX": "1",
        "PIP_FIND_LINKS": str(repository.parent / "wheels"),
        "PIP_CONFIG_FILE": os.devnull,
        **more,
    }


def start(repository: Path, *arguments: str, **more: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [str(repository / "curvrefl"), *arguments],
        env=environment(repository, **more),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=repository.parent,
    )


def call(repository: Path, *arguments: str, **more: str) -> tuple[int, str, str]:
    process = start(repository, *arguments, **more)
    out, err = process.communicate(timeout=300)
    return process.returncode, out, err


def test_without_python_and_blender_it_says_what_to_install(repository: Path) -> None:
    code, out, err = call(repository, "demo")
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert "install CPython 3.13" in err
    assert "BLENDER" in err
    assert not (repository / ".venv").exists()


def test_another_python_is_not_taken(repository: Path) -> None:
    older = repository.parent / "python-of-old"
    older.write_text("#!/bin/sh\necho cpython 3 12\n")
    older.chmod(0o755)
    code, _, err = call(repository, "demo", PYTHON=str(older))
    assert code == 2
    assert "install CPython 3.13" in err


def test_blender_gets_the_verb_after_two_dashes(repository: Path) -> None:
    blender = repository.parent / "my blender"
    blender.write_text('#!/bin/sh\nfor a in "$@"; do echo "<$a>"; done\nexit 5\n')
    blender.chmod(0o755)
    code, out, err = call(repository, "render", "a b.blend", "", BLENDER=str(blender))
    assert code == 5
    assert err == ""
    lines = out.split("\n")
    assert "<--background>" in lines and "<--factory-startup>" in lines
    assert lines[-5:] == ["<-->", "<render>", "<a b.blend>", "<>", ""]
    assert f"<{repository / 'tools' / 'run_verb.py'}>" in lines
    assert not (repository / ".venv").exists()


def test_a_blender_that_is_not_there_is_named(repository: Path) -> None:
    code, out, err = call(repository, "demo", BLENDER="/nowhere/blender")
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert "/nowhere/blender" in err


@needs_python_313
def test_life_of_an_environment(repository: Path) -> None:
    """Made once by two starts at once, then used, renewed for new requirements, and made again after a break."""
    # Two starts at once: one installs, the other waits for it.
    pair = [start(repository, "demo", "x y", PYTHON=sys.executable) for _ in range(2)]
    outcomes = [process.communicate(timeout=300) for process in pair]
    assert [process.returncode for process in pair] == [7, 7], outcomes
    assert [out for out, _ in outcomes] == ["1.0 -- demo x y\n"] * 2
    errors = "".join(err for _, err in outcomes)
    assert errors.count(PROGRESS) == 1
    assert errors.count("\n") == 1

    # Later starts need no Python but the environment's own, print nothing, and begin within a second.
    seconds = []
    for _ in range(3):
        begin = time.monotonic()
        assert call(repository, "demo") == (7, "1.0 -- demo\n", "")
        seconds.append(time.monotonic() - begin)
    assert min(seconds) < 1.0

    # Called through a link from somewhere else.
    link = repository.parent / "link"
    link.symlink_to(Path("a copy") / "curvrefl")
    linked = subprocess.run([str(link), "v"], env=environment(repository), capture_output=True, text=True)
    assert (linked.returncode, linked.stdout, linked.stderr) == (7, "1.0 -- v\n", "")

    # New requirements are installed into it.
    (repository / "requirements.txt").write_text("bpy==2.0\n")
    code, out, err = call(repository, "demo", PYTHON=sys.executable)
    assert (code, out) == (7, "2.0 -- demo\n")
    assert err.count(PROGRESS) == 1

    # Requirements that cannot be had: our failure, said with the reason, and nothing is taken for done.
    (repository / "requirements.txt").write_text("bpy==3.0\n")
    code, out, err = call(repository, "demo", PYTHON=sys.executable)
    assert (code, out) == (1, "")
    assert "bpy==3.0" in err
    assert "Traceback" not in err

    # What an interrupted installation left is thrown away.
    (repository / "requirements.txt").write_text("bpy==1.0\n")
    (module,) = (repository / ".venv").glob("lib/python3.13/site-packages/bpy.py")
    module.write_text("half of a mod")
    code, out, err = call(repository, "demo", PYTHON=sys.executable)
    assert (code, out) == (7, "1.0 -- demo\n")
    assert err.count(PROGRESS) == 1

    # An environment with the right packages is adopted, without a word.
    (repository / ".venv" / "curvrefl-installed.txt").unlink()
    assert call(repository, "demo", PYTHON=sys.executable) == (7, "1.0 -- demo\n", "")
    assert call(repository, "demo") == (7, "1.0 -- demo\n", "")


@needs_python_313
def test_an_environment_of_another_python_is_left_alone(repository: Path) -> None:
    python = repository / ".venv" / "bin" / "python"
    python.parent.mkdir(parents=True)
    python.write_text("#!/bin/sh\nexit 3\n")
    python.chmod(0o755)
    code, out, err = call(repository, "demo", PYTHON=sys.executable)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert "move it away" in err
    assert python.read_text() == "#!/bin/sh\nexit 3\n"
