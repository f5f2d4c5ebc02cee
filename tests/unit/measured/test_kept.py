# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measured costs are kept by device and driver, and nothing that is wrong with the file gets far."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.renderer.costs.table import NAMES, SHIPPED, Costs
from curvrefl.curvrefl_addon.renderer.measured import kept
from curvrefl.curvrefl_addon.renderer.measured.kept import (
    Measured,
    forget,
    keep,
    keep_verdict,
    read_kept,
    read_verdict,
)
from curvrefl.curvrefl_addon.renderer.proofs.verdict import Failure, Verdict

CARD = {"vendor": "Maker", "renderer": "Card 1", "version": "4.6 driver 10", "backend": "OPENGL", "more": "facts"}
FAST = Measured(replace(SHIPPED, pixel_by_ray=1e-4), "2026-01-02T03:04:05+00:00")
SLOW = Measured(replace(SHIPPED, vertex_solved=40.0), "2026-02-02T03:04:05+00:00")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "of the extension" / "devices.json"


def test_what_is_kept_is_read_again(path: Path) -> None:
    assert read_kept(path, CARD) is None
    keep(path, CARD, FAST)
    assert read_kept(path, CARD) == FAST
    content = json.loads(path.read_text())
    assert set(content["devices"][0]["device"]) == {"vendor", "renderer", "version", "backend"}
    assert content["schema"] == kept.SCHEMA


@pytest.mark.parametrize("name", kept.DEVICE)
def test_another_device_or_driver_has_nothing(path: Path, name: str) -> None:
    keep(path, CARD, FAST)
    assert read_kept(path, CARD | {name: "another"}) is None
    assert read_kept(path, CARD | {"more": "of no matter"}) == FAST


def test_devices_are_kept_beside_each_other_and_drivers_are_not(path: Path) -> None:
    other, newer = CARD | {"renderer": "Card 2"}, CARD | {"version": "4.6 driver 11"}
    keep(path, CARD, FAST)
    keep(path, other, SLOW)
    keep(path, newer, SLOW)
    assert read_kept(path, CARD) is None
    assert read_kept(path, other) == read_kept(path, newer) == SLOW
    forget(path, other)
    assert read_kept(path, other) is None and read_kept(path, newer) == SLOW
    assert len(json.loads(path.read_text())["devices"]) == 1


def test_verdicts_are_kept_beside_costs(path: Path) -> None:
    """Neither takes the other's place; those of another version of Blender or of the extension count for nothing."""
    wrong = Verdict(("list", "planar"), (Failure("list", "off", "atomics"),))
    assert read_verdict(path, CARD, "5.2") is None
    keep_verdict(path, CARD, "5.2", wrong)
    assert read_kept(path, CARD) is None
    keep(path, CARD, FAST)
    assert read_verdict(path, CARD, "5.2") == wrong and read_kept(path, CARD) == FAST
    assert read_verdict(path, CARD, "5.3") is None
    assert read_verdict(path, CARD | {"version": "another"}, "5.2") is None
    keep_verdict(path, CARD, "5.3", Verdict(("list",)))
    assert read_verdict(path, CARD, "5.2") is None and read_verdict(path, CARD, "5.3") == Verdict(("list",))
    assert read_kept(path, CARD) == FAST
    forget(path, CARD)
    assert read_verdict(path, CARD, "5.3") is None and read_kept(path, CARD) is None


@pytest.mark.parametrize(
    "change",
    [
        lambda entry: entry.pop("versions"),
        lambda entry: entry.update(failures=3),
        lambda entry: entry.update(failures={"list": {"words": "off", "without": "luck"}}),
        lambda entry: entry.pop("proven"),
    ],
)
def test_a_damaged_verdict_is_a_sentence(path: Path, change: Callable[[Any], Any]) -> None:
    keep_verdict(path, CARD, "5.2", Verdict(("list",)))
    content = json.loads(path.read_text())
    change(content["proofs"][0])
    path.write_text(json.dumps(content))
    with pytest.raises(InputError, match="is damaged"):
        read_verdict(path, CARD, "5.2")


def test_nothing_is_written_to_forget_nothing(path: Path) -> None:
    forget(path, CARD)
    assert not path.parent.exists()


def test_another_schema_counts_for_nothing(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    keep(path, CARD, FAST)
    monkeypatch.setattr(kept, "SCHEMA", kept.SCHEMA + 1)
    assert read_kept(path, CARD) is None
    keep(path, CARD, SLOW)
    assert read_kept(path, CARD) == SLOW


def _without(name: str) -> Callable[[Any], Any]:
    def change(content: Any) -> None:
        del content["devices"][0]["costs"][name]

    return change


def _with(name: str, value: Any) -> Callable[[Any], Any]:
    def change(content: Any) -> None:
        content["devices"][0]["costs"][name] = value

    return change


@pytest.mark.parametrize(
    "change",
    [
        _without("vertex_solved"),
        _with("vertex_solved", -1.0),
        _with("vertex_solved", float("nan")),
        _with("vertex_solved", float("inf")),
        _with("vertex_solved", "0.8"),
        _with("vertex_solved", True),
        _with("vertex_solved", None),
        _with("unknown", 1.0),
        lambda content: content.pop("devices"),
        lambda content: content.pop("schema"),
        lambda content: content.update(devices=7),
        lambda content: content["devices"][0].pop("device"),
        lambda content: content["devices"][0].update(measured=5),
        lambda content: content["devices"][0]["costs"].update(pixel_by_ray=0, pixel_by_ray_per_doubling=0),
    ],
)
def test_damaged_content_is_a_sentence_and_is_replaced(path: Path, change: Callable[[Any], Any]) -> None:
    keep(path, CARD, FAST)
    content = json.loads(path.read_text())
    change(content)
    path.write_text(json.dumps(content))
    with pytest.raises(InputError, match="is damaged: Measure This Device writes it anew"):
        read_kept(path, CARD)
    keep(path, CARD, SLOW)
    assert read_kept(path, CARD) == SLOW


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b"\xff\xfe\x00", b"null", b"[" * 100_000])
def test_what_is_no_such_file_is_a_sentence(path: Path, content: bytes) -> None:
    path.parent.mkdir()
    path.write_bytes(content)
    with pytest.raises(InputError, match="Measure This Device writes it anew"):
        read_kept(path, CARD)
    forget(path, CARD)
    assert read_kept(path, CARD) is None


def test_a_place_that_cannot_be_written_to_is_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="Cannot write"):
        keep(tmp_path / "file" / "devices.json", CARD, FAST)
    if os.name == "posix" and os.geteuid() != 0:
        tmp_path.chmod(0o500)
        with pytest.raises(InputError, match="Cannot write"):
            keep(tmp_path / "devices.json", CARD, FAST)
        tmp_path.chmod(0o700)


def test_the_table_holds_costs_alone() -> None:
    assert set(asdict(SHIPPED)) == set(NAMES)
    for wrong in (-0.1, float("nan"), float("inf"), "1", None, True):
        with pytest.raises(ValueError, match="layer_drawn is no cost"):
            replace(SHIPPED, layer_drawn=wrong)
    with pytest.raises(ValueError, match="rays cannot be free"):
        Costs(**(asdict(SHIPPED) | {"pixel_by_ray": 0.0, "pixel_by_ray_per_doubling": 0.0}))
