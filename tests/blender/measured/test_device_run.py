# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a session finds out about its device: once, kept for the next, and never in the way."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.renderer.costs.table import NAMES, SHIPPED, Costs, costs_in_use
from curvrefl.curvrefl_addon.renderer.measured import timing, unit_costs
from curvrefl.curvrefl_addon.renderer.proofs.proof import Found, Proof, Work
from curvrefl.curvrefl_addon.viewport import device_run

pytestmark = pytest.mark.usefixtures("gpu")
FOUND = replace(SHIPPED, pixel_by_ray=0.5)
SLICES = 3
"""Of measuring"""
PROVEN = 2
"""Slices of proofs before that, and of those after it"""


def right() -> Work:
    yield
    return Found(0.0, 1.0, "units")


FIRST = (Proof("list", "lists", right, ("atomics",)),)
OTHERS = (Proof("planar", "points", right, ("compute",), ("planar",)),)
ALL = PROVEN + SLICES + PROVEN


class Device:
    """One that is measured by counting to three, with made-up facts."""

    def __init__(self) -> None:
        self.facts = {"vendor": "Maker", "renderer": "Card", "version": "driver 1", "backend": "OPENGL"}
        self.measured = 0
        self.unrest = 1.0
        self.error: Exception | None = None

    def measure(self, found: Callable[[Costs, float], None]) -> Iterator[None]:
        for _ in range(SLICES - 1):
            yield
        if self.error is not None:
            raise self.error
        self.measured += 1
        found(FOUND, self.unrest)


@pytest.fixture
def device(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Device]:
    made = Device()
    monkeypatch.setattr("curvrefl.curvrefl_addon.renderer.measured.spread_run.LEAST_SECONDS", 0.0)
    monkeypatch.setattr(device_run, "platform_facts", lambda: dict(made.facts))
    monkeypatch.setattr(device_run, "measure_costs", made.measure)
    monkeypatch.setattr(device_run, "FIRST", FIRST)
    monkeypatch.setattr(device_run, "OTHERS", OTHERS)
    monkeypatch.setattr(device_run, "PACKAGE", "bl_ext.user_default.curvrefl")
    monkeypatch.setattr(bpy.utils, "extension_path_user", lambda _package: str(tmp_path / "user"))
    device_run.end_session()
    yield made
    device_run.end_session()


def redraws(measures: bool = True, is_resting: bool = True, most: int = 20) -> int:
    """Redraws of a viewport until nothing is left to do."""
    for count in range(1, most + 1):
        device_run.begin_session(measures)
        device_run.advance(is_resting)
        if not device_run.is_running():
            return count
    return most + 1


def new_session() -> None:
    device_run.end_session()
    assert costs_in_use() == SHIPPED


def test_the_first_use_measures_and_the_next_session_does_not(device: Device) -> None:
    assert redraws() == ALL
    assert costs_in_use() == FOUND and device_run.messages() == []
    assert redraws() == 1 and device.measured == 1
    new_session()
    assert redraws() == 1 and costs_in_use() == FOUND and device.measured == 1
    assert dict(device_run.rows())["Measured"][:2] == "20"


@pytest.mark.parametrize("name", ["renderer", "version", "backend"])
def test_another_device_or_driver_is_measured(device: Device, name: str) -> None:
    redraws()
    new_session()
    device.facts[name] = "another"
    device_run.begin_session(True)
    assert costs_in_use() == SHIPPED
    redraws()
    assert device.measured == 2


def test_nothing_is_done_while_the_view_moves(device: Device) -> None:
    assert redraws(is_resting=False) > 20
    assert device.measured == 0 and costs_in_use() == SHIPPED
    assert redraws() == ALL


def test_a_user_who_does_not_want_it_is_not_measured(device: Device) -> None:
    assert redraws(measures=False) == 1 and device.measured == 0
    assert device_run.measure_now() == "" and costs_in_use() == FOUND
    new_session()
    # (What was measured on request is used all the same.)
    assert redraws(measures=False) == 1 and costs_in_use() == FOUND


def test_looking_at_the_preferences_before_does_not_keep_it_from_being_measured(
    device: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(device_run, "bpy", SimpleNamespace(app=SimpleNamespace(background=False), utils=bpy.utils))
    rows = {"Device": "Card", "Driver": "driver 1", "Measured": "Not yet", "Results": "Not proven yet"}
    assert dict(device_run.rows()) == rows
    assert redraws() == ALL and device.measured == 1


def test_another_file_begins_it_anew(device: Device) -> None:
    device_run.begin_session(True)
    device_run.advance()
    device_run.cancel()
    assert not device_run.is_running() and device.measured == 0
    assert redraws() == ALL and device.measured == 1
    # Once it is known, another file changes nothing.
    device_run.cancel()
    assert redraws() == 1 and costs_in_use() == FOUND


def test_a_failure_is_one_sentence_and_is_not_tried_again(device: Device, capsys: pytest.CaptureFixture[str]) -> None:
    device.error = RuntimeError("the driver is on holiday")
    redraws()
    assert device_run.messages() == ["Measuring this device has failed: the driver is on holiday."]
    assert redraws() == 1 and costs_in_use() == SHIPPED
    assert capsys.readouterr().err.count("Traceback") == 1


def test_costs_of_a_restless_machine_are_not_kept(device: Device) -> None:
    device.unrest = 2.0
    redraws()
    assert costs_in_use() == SHIPPED
    assert "other work" in device_run.messages()[0] and redraws() == 1
    new_session()
    device.unrest = 1.1
    assert redraws() == SLICES and costs_in_use() == FOUND and device_run.messages() == []
    # Who asks for it gets it.
    device.unrest = 2.0
    assert device_run.measure_now() == "" and device.measured == 3


def test_a_damaged_file_is_one_sentence(device: Device, tmp_path: Path) -> None:
    (tmp_path / "user").mkdir()
    (tmp_path / "user" / device_run.FILE).write_text("{")
    assert redraws() == 1 and costs_in_use() == SHIPPED
    assert len(device_run.messages()) == 1 and "is damaged" in device_run.messages()[0]
    assert device_run.measure_now() == "" and device_run.messages() == []
    new_session()
    assert redraws() == 1 and costs_in_use() == FOUND


def test_a_folder_that_cannot_be_written_to_is_one_sentence(device: Device, tmp_path: Path) -> None:
    """Nothing is measured by itself, which every session would do again; on request it lasts as long as the session."""
    (tmp_path / "user").write_text("a file in its place")
    assert redraws() == 1 and device.measured == 0 and costs_in_use() == SHIPPED
    assert len(device_run.messages()) == 1 and "could not be kept" in device_run.messages()[0]
    assert "lasts until Blender ends" in device_run.measure_now()
    assert costs_in_use() == FOUND


def test_forgetting_brings_the_shipped_costs_back(device: Device) -> None:
    redraws()
    assert device_run.forget_device() == "" and costs_in_use() == SHIPPED
    assert redraws() == 1, "not again in this session"
    new_session()
    assert redraws() == ALL and device.measured == 2


def test_without_an_installed_extension_nothing_is_kept(
    device: Device, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(device_run, "PACKAGE", "curvrefl")
    assert redraws() == 1 and device.measured == 0
    assert device_run.measure_now() == "" and costs_in_use() == FOUND
    assert not (tmp_path / "user").exists()
    assert device_run.forget_device() == ""


@pytest.mark.usefixtures("registered")
def test_operators_measure_and_forget(device: Device) -> None:
    assert bpy.ops.curvrefl.measure_device() == {"FINISHED"}
    assert costs_in_use() == FOUND
    assert bpy.ops.curvrefl.forget_device() == {"FINISHED"}
    assert costs_in_use() == SHIPPED


@pytest.fixture
def registered() -> Iterator[None]:
    from curvrefl.curvrefl_addon import registration

    registration.register()
    yield
    registration.unregister()


def test_the_verb_measures_and_writes_what_it_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """For real, with little work."""
    for name, value in (("MANY", 1600), ("SIZES", (64,)), ("TRIANGLES", (200, 800)), ("POINTS", (256, 512))):
        monkeypatch.setattr(unit_costs, name, value)
    monkeypatch.setattr(timing, "MOST_AT_ONCE", 1)
    try:
        assert cli.main(["benchmark", "--calibrate", "--output", str(tmp_path)]) == 0
        written = json.loads((tmp_path / "costs.json").read_text())
        assert Costs(**written["costs"]) == costs_in_use() != SHIPPED
    finally:
        device_run.end_session()
    printed = capfd.readouterr().out
    assert written["device"]["renderer"] in printed
    assert all(name in printed for name in NAMES)
    assert [path.name for path in tmp_path.iterdir()] == ["costs.json"]
