# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What proofs have found of a device is in use at once, kept beside its costs, and known in the next session."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon.engine import session as engine_session
from curvrefl.curvrefl_addon.renderer.costs.table import SHIPPED, Costs
from curvrefl.curvrefl_addon.renderer.device.ways.features import Features, features
from curvrefl.curvrefl_addon.renderer.proofs.proof import Found, Proof, Work
from curvrefl.curvrefl_addon.renderer.proofs.verdict import known_verdict
from curvrefl.curvrefl_addon.viewport import device_run

pytestmark = pytest.mark.usefixtures("gpu")
FACTS = {"vendor": "Maker", "renderer": "Card", "version": "driver 1", "backend": "OPENGL"}


class Driver:
    """One whose image atomics, or points by `planar`, are wrong."""

    def __init__(self) -> None:
        self.wrong = {"list"}
        self.tried: list[str] = []
        self.measured_with: list[Features] = []

    def proof(self, name: str, feature: str, *methods: str) -> Proof:
        def work() -> Work:
            yield
            self.tried.append(name)
            is_usual = getattr(features(), feature)
            return Found(9.0 if name in self.wrong and (is_usual or feature != "atomics") else 0.0, 1.0, "units")

        return Proof(name, f"what {name} is about", work, (feature,), methods)

    def measure(self, found: Callable[[Costs, float], None]) -> Iterator[None]:
        yield
        self.measured_with.append(features())
        found(SHIPPED, 1.0)


@pytest.fixture
def driver(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Driver]:
    made = Driver()
    monkeypatch.setattr(device_run, "platform_facts", lambda: dict(FACTS))
    monkeypatch.setattr(device_run, "measure_costs", made.measure)
    monkeypatch.setattr(device_run, "FIRST", (made.proof("list", "atomics"),))
    monkeypatch.setattr(device_run, "OTHERS", (made.proof("planar", "compute", "planar"),))
    monkeypatch.setattr(device_run, "PACKAGE", "bl_ext.user_default.curvrefl")
    monkeypatch.setattr(bpy.utils, "extension_path_user", lambda _package: str(tmp_path))
    device_run.end_session()
    yield made
    device_run.end_session()
    assert features() == Features()


def use(most: int = 30) -> None:
    """Redraws until nothing is left to do."""
    for _ in range(most):
        device_run.begin_session(True)
        device_run.advance()
    assert not device_run.is_running() and device_run.messages() == []


def content(folder: Path) -> Any:
    return json.loads((folder / device_run.FILE).read_text())


def test_what_is_wrong_goes_another_way_before_anything_is_measured(driver: Driver, tmp_path: Path) -> None:
    use()
    assert features().missing == ("atomics",)
    assert driver.measured_with == [Features(atomics=False)]
    assert "what list is about" not in known_verdict().sentence, "its subject is the table's"
    assert "lists by image atomics" in known_verdict().sentence
    (entry,) = content(tmp_path)["proofs"]
    assert entry["device"] == FACTS and entry["proven"] == ["list", "planar"]
    assert entry["failures"] == {"list": {"words": "off by 9 units, 1 allowed", "without": "atomics"}}
    assert dict(device_run.rows())["Results"] == "1 of 2 proofs are right, but not list"


def test_the_next_session_knows_it(driver: Driver) -> None:
    driver.wrong.add("planar")
    use()
    tried = list(driver.tried)
    device_run.end_session()
    assert features() == Features() and known_verdict().sentence == ""
    device_run.begin_session(True)
    assert features().missing == ("atomics",) and features().distrusted == {"planar"}
    use()
    assert driver.tried == tried and len(driver.measured_with) == 1


@pytest.mark.parametrize("change", ["driver", "versions"])
def test_another_driver_or_version_is_proven_anew(
    driver: Driver, change: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    use()
    device_run.end_session()
    driver.wrong.clear()
    if change == "driver":
        monkeypatch.setattr(device_run, "platform_facts", lambda: {**FACTS, "version": "driver 2"})
    else:
        monkeypatch.setattr(device_run, "versions", lambda: "another")
    use()
    assert features() == Features() and known_verdict().sentence == ""
    # (Costs hold whatever the version of Blender.)
    assert len(driver.measured_with) == (2 if change == "driver" else 1)
    assert len(content(tmp_path)["proofs"]) == len(content(tmp_path)["devices"]) == 1


def test_a_user_who_does_not_want_it_is_not_asked_but_can_ask(driver: Driver, tmp_path: Path) -> None:
    device_run.begin_session(False)
    assert not device_run.is_running() and not driver.tried
    proving = device_run.prove_now()
    # For real: the report is of all that there is.
    assert len(proving.verdict.proven) > 10 and known_verdict() == proving.verdict
    assert content(tmp_path)["proofs"][0]["proven"] == list(proving.verdict.proven)
    assert content(tmp_path)["devices"] == []


def test_forgetting_forgets_proofs_too(driver: Driver, tmp_path: Path) -> None:
    use()
    assert device_run.forget_device() == ""
    assert content(tmp_path) == {"schema": 1, "devices": [], "proofs": []}
    device_run.end_session()
    driver.wrong.clear()
    use()
    assert features() == Features()


def test_in_background_what_is_known_to_be_wrong_is_not_used(driver: Driver, tmp_path: Path) -> None:
    """Whatever draws there: a verb, F12, a farm."""
    assert device_run.take_what_is_known() == "" and features() == Features()
    use()
    device_run.end_session()
    assert features() == Features()
    assert device_run.take_what_is_known() == ""
    assert features().missing == ("atomics",) and not device_run.is_running()
    assert engine_session.take_what_is_known is device_run.take_what_is_known
    (tmp_path / device_run.FILE).write_text("{")
    assert "is damaged" in device_run.take_what_is_known()


def test_what_was_drawn_by_a_wrong_way_is_let_go(driver: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    """After the redraw, which goes on with it."""
    timers: list[Callable[[], None]] = []
    forgotten: list[bool] = []
    app = SimpleNamespace(background=False, timers=SimpleNamespace(register=timers.append))
    monkeypatch.setattr(device_run, "bpy", SimpleNamespace(app=app, utils=bpy.utils))
    monkeypatch.setattr(device_run, "forget_scenes", lambda: forgotten.append(True))
    use()
    assert len(timers) == 1 and not forgotten
    timers[0]()
    assert forgotten == [True]
