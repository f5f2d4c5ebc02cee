# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports run one way, and the check that says so sees each kind that does not."""

from __future__ import annotations

from pathlib import Path

import pytest
from checks import imports

ROOT = Path(__file__).resolve().parents[3]


def house(folder: Path, **files: str) -> Path:
    """A small source with these files, named like scene__extract, and a package in each folder."""
    (folder / "__init__.py").write_text("from .curvrefl_addon import registration\n")
    everything = {"registration": "", "optics__ray": "", "renderer__renderer": "", **files}
    for name, text in everything.items():
        path = folder.joinpath("curvrefl_addon", *name.split("__")).with_suffix(".py")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    for package in ("operators", "gpu_shaders"):
        (folder / package).mkdir()
    for path in [path for path in folder.rglob("*") if path.is_dir()]:
        (path / "__init__.py").touch()
    return folder


def test_the_rooms_import_one_way() -> None:
    assert imports.violations(ROOT) == []


def test_every_room_of_the_table_is_there() -> None:
    rooms = [room for tier in imports.TIERS for room in tier if room]
    assert len(rooms) == len(set(rooms))
    for room in rooms:
        place = ROOT / "curvrefl_addon" / Path(*room.split("."))
        assert place.is_dir() or place.with_suffix(".py").is_file() or (ROOT / room).is_dir(), room


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("optics__mirror", "from ..scene.arrays import A", "optics may not import from scene"),
        ("optics__mirror", "def f():\n    from ..renderer import renderer", "mirror.py:2: optics may not import"),
        ("scene__arrays", "from ..renderer.settings import S", "scene may not import from renderer.settings"),
        ("renderer__rays__walk", "from ..lighting import suns", "renderer.rays may not import from renderer.lighting"),
        ("renderer__rays__walk", "from ..renderer import Renderer", "renderer.rays may not import from renderer."),
        ("renderer__rays__walk", "from ...study.oracle import O", "renderer.rays may not import from study"),
        ("scene__arrays", "from .. import registration", "scene may not import from registration"),
        ("cellar", "", "cellar.py: is in no room"),
        ("scene__arrays", "from ..cellar import wine", "curvrefl_addon.cellar is in no room"),
    ],
)
def test_imports_that_go_up_or_sideways_are_named(tmp_path: Path, name: str, text: str, said: str) -> None:
    found = imports.violations(house(tmp_path, **{name: text}))
    assert len(found) == 1
    assert said in found[0]


def test_imports_that_go_down_or_stay_are_not(tmp_path: Path) -> None:
    text = "from ..optics.ray import R\nfrom .settings import S\nfrom .rays.walk import w\nfrom . import settings\n"
    files = {
        "renderer__frame": text,
        "renderer__settings": "from ..errors import E\n",
        "errors": "",
        "renderer__rays__walk": "",
    }
    assert imports.violations(house(tmp_path, **files)) == []
