# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of the documents: each is made by the command, and each that a document shows is there."""

from __future__ import annotations

import re
from pathlib import Path

import make_images
import pytest
from curvrefl.curvrefl_addon.command import cli

ROOT = Path(__file__).resolve().parents[3]
DOCUMENTS = (*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"))


def test_every_picture_is_made_by_the_command() -> None:
    assert {path.name for path in make_images.IMAGES_FOLDER.iterdir()} == {*make_images.IMAGES, *make_images.KEPT}
    assert {picture.results for picture in make_images.IMAGES.values()} == set(make_images.RESULTS)


def test_every_picture_is_shown_and_every_shown_one_is_there() -> None:
    shown = {
        (document.parent / link).resolve()
        for document in DOCUMENTS
        for link in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", document.read_text(encoding="utf-8"))
    }
    assert shown == set(make_images.IMAGES_FOLDER.iterdir())


def test_links_between_documents_lead_somewhere() -> None:
    for document in DOCUMENTS:
        for link in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", document.read_text(encoding="utf-8")):
            assert link.startswith("https://") or (document.parent / link).exists(), f"{document.name}: {link}"


def test_pictures_are_cut_and_put_side_by_side(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Out of pictures of a window in plain colors, one per view."""
    image = pytest.importorskip("PIL.Image")

    def window(folder: Path) -> None:
        for number, name in enumerate((*(f"show_{view}" for view in make_images.VIEWS), "panel_tools")):
            image.new("RGB", (1280, 800), (40 * number, 0, 0)).save(folder / f"{name}.png")

    monkeypatch.setitem(make_images.RESULTS, "window", window)
    make_images.make(["diagnostics.jpg", "panel_tools.jpg"], tmp_path / "new")
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == ["diagnostics.jpg", "panel_tools.jpg"]
    views = image.open(tmp_path / "new" / "diagnostics.jpg")
    assert views.size == (1050, 1038)
    reds = [views.getpixel((262 + 525 * (number % 2), 173 + 346 * (number // 2)))[0] for number in range(6)]
    assert reds == pytest.approx([0, 40, 80, 120, 160, 200], abs=3)
    assert image.open(tmp_path / "new" / "panel_tools.jpg").size == (360, 320)


def test_a_missing_picture_of_the_window_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("PIL.Image")
    monkeypatch.setitem(make_images.RESULTS, "window", lambda _folder: None)
    with pytest.raises(make_images.InputError, match="ImageMagick"):
        make_images.make(["trace.jpg"], tmp_path / "new")
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_picture_is_one_sentence(capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["images", "cellar.jpg"]) == 2
    assert capfd.readouterr().err.startswith('curvrefl: There is no picture "cellar.jpg": choose from demo.jpg, ')
