# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results appear whole or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest
from curvrefl.curvrefl_addon import output
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.output import checked_file, checked_folder, folder_to_publish, write_whole


def test_files_arrive_at_the_end_the_report_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "new" / "deeper"
    moved = []
    replace = output.os.replace

    def record(source: Path, destination: Path) -> None:
        moved.append(Path(destination).name)
        replace(source, destination)

    monkeypatch.setattr(output.os, "replace", record)
    with folder_to_publish(target) as folder:
        for name in ("report.json", "a.txt", "z.txt"):
            (folder / name).write_text(name)
        assert not target.exists()
    assert moved == ["a.txt", "z.txt", "report.json"]
    assert sorted(path.name for path in target.iterdir()) == ["a.txt", "report.json", "z.txt"]
    assert [path.name for path in tmp_path.iterdir()] == ["new"]


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
