# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The release verb, in a copy of the source that is a repository of its own."""

from __future__ import annotations

import shutil
import subprocess
import sys
import zipfile
from datetime import date
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
COPIED = (
    *("__init__.py", "blender_manifest.toml", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "README.md", ".gitignore"),
    *("curvrefl_addon", "gpu_shaders", "operators", "tools"),
)
CHECKS = "tools/checks/source.py"
NEXT = "900.0.1"


def git(root: Path, *arguments: str) -> str:
    identity = ("-c", "user.name=Someone", "-c", "user.email=someone@example.org")
    return subprocess.run(["git", *identity, *arguments], cwd=root, check=True, capture_output=True, text=True).stdout


def set_checks(root: Path, code: int) -> None:
    """Checks that end with this code at once: what they check has tests of its own."""
    (root / CHECKS).write_text(f"def run() -> int:\n    print('checked')\n    return {code}\n")
    git(root, "commit", "--quiet", "--all", "--message", "Quick checks")


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A clean repository with a change to release."""
    if shutil.which("git") is None:
        pytest.skip("no git")
    root = tmp_path / "a copy"
    root.mkdir()
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, root / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(ROOT / name, root / name)
    (root / "CHANGELOG.md").write_text(
        "# Changes\n\n## [Unreleased]\n\n### Added\n\n* A thing.\n\n## [0.0.1] - 2026-01-02\n\n* Old.\n"
    )
    git(root, "init", "--quiet")
    git(root, "config", "user.name", "Someone")
    git(root, "config", "user.email", "someone@example.org")
    git(root, "add", "--all")
    git(root, "commit", "--quiet", "--message", "A copy")
    set_checks(root, 0)
    return root


def release(root: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(root / "tools" / "run_verb.py"), "--", "release", *arguments]
    return subprocess.run(command, cwd=root, capture_output=True, text=True, timeout=300)


def refused(root: Path, said: str, *arguments: str) -> None:
    """One sentence, exit code 2, and the source and its repository are as they were."""
    before = (git(root, "status", "--porcelain"), git(root, "log", "--oneline"), git(root, "diff"))
    result = release(root, *arguments)
    assert (result.returncode, result.stderr.count("\n")) == (2, 1), result.stderr
    assert said in result.stderr
    assert (git(root, "status", "--porcelain"), git(root, "log", "--oneline"), git(root, "diff")) == before
    assert not (root / "dist").exists()
    assert git(root, "tag") == ""


@pytest.mark.parametrize(
    ("version", "said"),
    [
        ("banana", '"banana" is not a version like 0.2.0'),
        ("1.2", "is not a version"),
        ("01.2.3", "is not a version"),
        ("v1.2.3", "is not a version"),
        ("0.0.0", "lower than"),
        ("0.0.1", "released already"),
    ],
)
def test_a_bad_version_is_refused(copy: Path, version: str, said: str) -> None:
    refused(copy, said, version)


def test_a_dirty_tree_is_refused(copy: Path) -> None:
    (copy / "README.md").write_text("Mine.\n")
    refused(copy, "not committed", NEXT)
    git(copy, "checkout", "--", "README.md")
    (copy / "new.py").write_text("")
    refused(copy, "not committed", NEXT)


def test_a_changelog_without_changes_is_refused(copy: Path) -> None:
    (copy / "CHANGELOG.md").write_text("# Changes\n\n## [Unreleased]\n\n## [0.0.1] - 2026-01-02\n\n* Old.\n")
    git(copy, "commit", "--quiet", "--all", "--message", "Nothing new")
    refused(copy, "lists no unreleased change", NEXT)


def test_a_copy_that_is_no_repository_is_refused(copy: Path) -> None:
    shutil.rmtree(copy / ".git")
    result = release(copy, NEXT)
    assert result.returncode == 2
    assert "needs a git repository" in result.stderr
    assert NEXT not in (copy / "blender_manifest.toml").read_text()


def test_failed_checks_leave_the_source_as_it_was(copy: Path) -> None:
    set_checks(copy, 1)
    refused(copy, "fails its checks", NEXT)


def test_a_release_is_checked_packed_and_left_to_commit(copy: Path) -> None:
    pytest.importorskip("bpy", reason="packing the extension needs a Python with Blender")
    log = git(copy, "log", "--oneline")
    result = release(copy, NEXT)
    assert result.returncode == 0, result.stderr
    assert "checked" in result.stdout
    assert result.stdout.splitlines()[-1] == str(copy / "dist" / f"curvrefl-{NEXT}.zip")
    packed = zipfile.ZipFile(copy / "dist" / f"curvrefl-{NEXT}.zip")
    assert f'version = "{NEXT}"' in packed.read("blender_manifest.toml").decode()
    assert not {"CHANGELOG.md", "CONTRIBUTING.md"} & set(packed.namelist())
    assert (copy / "CHANGELOG.md").read_text() == (
        f"# Changes\n\n## [Unreleased]\n\n## [{NEXT}] - {date.today().isoformat()}\n\n### Added\n\n* A thing.\n\n"
        "## [0.0.1] - 2026-01-02\n\n* Old.\n"
    )
    assert git(copy, "status", "--porcelain").split() == ["M", "CHANGELOG.md", "M", "blender_manifest.toml"]
    assert (git(copy, "log", "--oneline"), git(copy, "tag")) == (log, "")


def test_with_tag_it_is_committed_and_tagged(copy: Path) -> None:
    pytest.importorskip("bpy", reason="packing the extension needs a Python with Blender")
    result = release(copy, NEXT, "--tag")
    assert result.returncode == 0, result.stderr
    assert git(copy, "status", "--porcelain") == ""
    assert git(copy, "tag", "--points-at", "HEAD").strip() == f"v{NEXT}"
    assert git(copy, "log", "-1", "--format=%s").strip() == f"Version {NEXT}"
