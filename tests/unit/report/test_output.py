# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results appear whole or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest
from curvrefl.curvrefl_addon import output
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.output import checked_file, checked_folder, folder_to_publish, write_whole


def test_a_new_folder_is_there_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "new" / "deeper"

    def deny(*_arguments: object) -> None:
        raise AssertionError("a file is moved by itself")

    with folder_to_publish(target) as folder:
        for name in ("report.json", "a.txt", "z.txt"):
            (folder / name).write_text(name)
        (folder / "kept").mkdir()
        (folder / "kept" / "b.txt").write_text("b")
        assert not target.exists()
        monkeypatch.setattr(output.os, "replace", deny)
    assert sorted(path.name for path in target.iterdir()) == ["a.txt", "kept", "report.json", "z.txt"]
    assert (target / "kept" / "b.txt").read_text() == "b"
    assert [path.name for path in tmp_path.iterdir()] == ["new"]


def test_files_arrive_one_by_one_and_the_last_stands_for_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("report.json", "mine.txt"):
        (tmp_path / name).write_text("old")
    moved, replace = [], output.os.replace

    def record(source: Path, destination: Path) -> None:
        moved.append((Path(destination).name, (tmp_path / "report.json").exists()))
        replace(source, destination)

    monkeypatch.setattr(output.os, "replace", record)
    with folder_to_publish(tmp_path) as folder:
        (folder / "kept").mkdir()
        for name in ("report.json", "a.txt", "z.txt", "kept/report.txt"):
            (folder / name).write_text(name)
    there = [("replaced", True), ("a.txt", False), ("report.txt", False), ("z.txt", False), ("report.json", False)]
    assert moved == there
    assert (tmp_path / "mine.txt").read_text() == "old" and (tmp_path / "report.json").read_text() == "report.json"
    assert len(list(tmp_path.iterdir())) == 5


def test_where_a_file_cannot_be_moved_the_last_is_what_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "z.txt").write_text("old")
    replace = output.os.replace

    def fail(source: Path, destination: Path) -> None:
        if Path(source).name == "z.txt" and Path(destination).name == "z.txt":
            raise PermissionError(13, "Permission denied", str(destination))
        replace(source, destination)

    monkeypatch.setattr(output.os, "replace", fail)
    with pytest.raises(InputError, match="Permission denied"), folder_to_publish(tmp_path) as folder:
        (folder / "a.txt").write_text("new")
        (folder / "z.txt").write_text("new")
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("z.txt", "old")]


def test_a_failure_leaves_what_was_there(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old")
    with pytest.raises(ZeroDivisionError), folder_to_publish(tmp_path) as folder:
        (folder / "a.txt").write_text("half")
        raise ZeroDivisionError
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "old"


def test_older_results_are_replaced(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old")
    (tmp_path / "mine.txt").write_text("kept")
    with folder_to_publish(tmp_path) as folder:
        (folder / "a.txt").write_text("new")
    assert (tmp_path / "a.txt").read_text() == "new"
    assert (tmp_path / "mine.txt").read_text() == "kept"


def test_checks_write_nothing(tmp_path: Path) -> None:
    assert checked_folder(tmp_path / "b" / "c") == tmp_path / "b" / "c"
    assert checked_file(tmp_path / "b" / "x.PNG", (".png",)) == tmp_path / "b" / "x.PNG"
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_written_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def deny(**_options: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(output.tempfile, "TemporaryFile", deny)
    with pytest.raises(InputError, match="Permission denied"):
        checked_folder(tmp_path / "x")
    with pytest.raises(InputError, match="Permission denied"):
        checked_file(tmp_path / "x.png", (".png",))


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    file = tmp_path / "numbers.txt"
    write_whole(file, "one\n")
    write_whole(file, "two\n")
    with pytest.raises(UnicodeEncodeError):
        write_whole(file, "three \udc00\n")
    assert file.read_text() == "two\n"
    assert list(tmp_path.iterdir()) == [file]
