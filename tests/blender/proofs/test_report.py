# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a bug report needs, and what the panel says of a device that is wrong."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.renderer.device.context import device_limits, platform_facts
from curvrefl.curvrefl_addon.renderer.device.ways.features import features
from curvrefl.curvrefl_addon.renderer.proofs.proving import prove_all
from curvrefl.curvrefl_addon.renderer.proofs.report import device_report, summary
from curvrefl.curvrefl_addon.renderer.proofs.table import PROOFS
from curvrefl.curvrefl_addon.renderer.proofs.verdict import Verdict, known_verdict, take_verdict
from curvrefl.curvrefl_addon.ui.panel import CURVREFL_PT_main
from curvrefl.curvrefl_addon.viewport import device_run
from proofs.broken import broken
from viewport.layouts import context, draw

pytestmark = pytest.mark.usefixtures("gpu")

NO_ATOMICS = ("imageAtomicAdd(straggler_count, ivec2(0), 1u)", "0u")
FARTHER = ("          hit.range = range;", "          hit.range = 1.001 * range;")


@pytest.fixture(autouse=True)
def registered() -> Iterator[None]:
    bpy.ops.wm.read_factory_settings()
    registration.register()
    yield
    registration.unregister()
    take_verdict(Verdict())


def test_it_has_what_a_bug_report_needs() -> None:
    text = device_report(prove_all())
    manifest = tomllib.loads((Path(__file__).parents[3] / "blender_manifest.toml").read_text())
    assert f"Curvrefl {manifest['version']}, Blender {bpy.app.version_string}" in text
    for fact in platform_facts().values():
        assert fact in text
    for limit in device_limits().values():
        assert f"{limit:,}" in text
    assert "In use: compute, atomics, quads, fits\n" in text and "Not in use" not in text
    assert f"Proofs: {len(PROOFS)} of {len(PROOFS)} right" in text
    for proof in PROOFS:
        (line,) = [line for line in text.splitlines() if line.split()[1:2] == [proof.name]]
        assert line.split()[0] == "right" and "off by" in line


def test_it_says_which_proofs_failed() -> None:
    with broken(*NO_ATOMICS):
        text = device_report(prove_all())
    assert "In use: compute, quads, fits\nNot in use: atomics" in text
    assert f"Proofs: {len(PROOFS) - 1} of {len(PROOFS)} right" in text
    assert "another way list" in " ".join(text.split()) and "by the usual way: off by" in text
    with broken(*FARTHER):
        proving = prove_all()
    text = device_report(proving)
    assert "WRONG rays off by" in " ".join(text.split())
    assert "Not taken by Automatic: exact" in text
    assert "are right, but not rays" in summary(proving.verdict)


def test_the_operator_copies_it_and_the_panel_says_it(monkeypatch: pytest.MonkeyPatch) -> None:
    copied = []
    forgotten = []
    monkeypatch.setattr(device_run, "forget_scenes", lambda: forgotten.append(True))
    timers = SimpleNamespace(register=lambda act: act())
    app = SimpleNamespace(background=False, timers=timers)
    monkeypatch.setattr(device_run, "bpy", SimpleNamespace(app=app, utils=bpy.utils))
    from curvrefl.operators import copy_report

    window_manager = SimpleNamespace()
    reported: list[str] = []
    operator = SimpleNamespace(report=lambda _kind, text: reported.append(text))
    run = copy_report.CURVREFL_OT_copy_report.execute
    asked = SimpleNamespace(window_manager=window_manager)
    assert run(operator, asked) == {"FINISHED"}  # type: ignore[arg-type]
    copied.append(window_manager.clipboard)
    assert known_verdict().sentence == "" and not forgotten
    with broken(*NO_ATOMICS):
        assert run(operator, asked) == {"FINISHED"}  # type: ignore[arg-type]
        copied.append(window_manager.clipboard)
        # What was solved with a list is let go, once.
        assert forgotten == [True] and features().missing == ("atomics",)
        assert run(operator, asked) == {"FINISHED"}  # type: ignore[arg-type]
        assert forgotten == [True]
    assert "Not in use: atomics" in copied[1] and "Not in use" not in copied[0]
    assert reported[0].startswith("The report is in the clipboard: ") and "but not list" in reported[1]
    shown = draw(CURVREFL_PT_main, context())
    assert shown is not None
    said = " ".join(shown.texts)
    assert known_verdict().sentence and " ".join(known_verdict().sentence.split()) in " ".join(said.split())
    assert "curvrefl.copy_report" in shown.shown


def test_it_is_an_operator() -> None:
    assert bpy.ops.curvrefl.copy_report() == {"FINISHED"}
