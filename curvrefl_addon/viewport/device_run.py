# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is found out about the device at its first use, a slice in each redraw of a view that rests, and kept.

Kept are what proofs have found and the costs that `auto` counts with, in the extension's own folder of the user's, so
that all is done once for each device and driver. In background nothing of this is done unless it is asked for: there
what is known to be wrong goes another way, and `auto` counts with the costs that ship, the same on all machines that
share a render.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import bpy

from ..errors import InputError
from ..options import PACKAGE
from ..output import checked_folder
from ..renderer.costs.table import SHIPPED, Costs, use_costs
from ..renderer.device.context import platform_facts, require_gpu
from ..renderer.measured.kept import Measured, forget, keep, keep_verdict, read_kept, read_verdict
from ..renderer.measured.spread_run import SpreadRun, Task
from ..renderer.measured.unit_costs import measure_costs
from ..renderer.proofs.proof import Proof
from ..renderer.proofs.proving import Proving, prove_all
from ..renderer.proofs.report import summary, versions
from ..renderer.proofs.table import FIRST, OTHERS
from ..renderer.proofs.verdict import Verdict, known_verdict, take_verdict
from .state import forget_scenes

FILE = "devices.json"
MOST_UNREST = 1.25
"""Costs are not kept where things usually took more than so many times their least: the machine had other work"""


@dataclass
class _State:
    """Of this session."""

    device: dict[str, str] = field(default_factory=dict)
    """Facts of it, once it was looked at"""
    has_begun: bool = False
    """Nothing more is to be measured by itself"""
    measured: Measured | None = None
    """Costs in use"""
    verdict: Verdict | None = None
    """In use, once all proofs are through"""
    run: SpreadRun | None = None
    problem: str = ""
    """One sentence for the user"""
    is_asked: bool = False
    """The user asked for the run: its costs are taken however restless the machine is"""


_state = _State()


def begin_session(measures: bool) -> None:
    """At a redraw: at the first one of a session take what is kept of the device, or begin to find it out where it
    `measures`."""
    if _state.has_begun:
        return
    _state.has_begun = True
    if not _state.device:
        _look_up()
    if measures and None in (_state.measured, _state.verdict) and not _state.problem:
        try:
            if (file := _file()) is not None:
                checked_folder(file.parent)
                _begin(proves=_state.verdict is None, measures=_state.measured is None)
        except InputError as error:
            _state.problem = f"What this device costs is not measured, as it could not be kept: {error}"


def advance(is_resting: bool = True) -> None:
    """Do a slice of the run, if there is one, in a redraw of a view that `is_resting`. Never raises."""
    run = _state.run
    if run is None or not is_resting:
        return
    run.advance()
    if run.is_done:
        _state.run = None
        _state.problem = run.failure or _state.problem


def is_running() -> bool:
    """There is something left to do in later redraws."""
    return _state.run is not None


def take_what_is_known() -> str:
    """In background, before anything is drawn: have what is known to be wrong go another way; returns as
    `measure_now`."""
    if bpy.app.background and not _state.device:
        facts = platform_facts()
        try:
            known = None if (file := _file()) is None else read_verdict(file, facts, versions())
        except InputError as error:
            return str(error)
        take_verdict(known or Verdict())
    return ""


def prove_now() -> Proving:
    """All proofs at once, as the user asks. Needs a GPU context."""
    cancel()
    _state.device, _state.has_begun = platform_facts(), True
    _state.problem = ""
    proving = prove_all()
    _proven(proving.verdict)
    return proving


def measure_now() -> str:
    """Prove and measure at once, as the user asks; returns what is wrong, one sentence, or nothing. What is found is in
    use, and kept where there is a folder for it.

    Raises GpuUnavailableError without a GPU.
    """
    require_gpu()
    cancel()
    _state.device, _state.has_begun = platform_facts(), True
    _state.problem = ""
    _begin(proves=True, measures=True)
    _state.is_asked = True
    while is_running():
        advance()
    return _state.problem


def forget_device() -> str:
    """Count with the costs that ship, in this session, and keep nothing of the device; returns as `measure_now`. What
    is known to be wrong stays so until the session's end.

    Raises GpuUnavailableError without a GPU.
    """
    require_gpu()
    cancel()
    _state.device, _state.has_begun = platform_facts(), True
    _state.measured, _state.problem = None, ""
    use_costs(SHIPPED)
    try:
        if (file := _file()) is not None:
            forget(file, _state.device)
    except InputError as error:
        _state.problem = str(error)
    return _state.problem


def cancel() -> None:
    """End a run: it begins anew in the next redraw that finds the device unknown."""
    if _state.run is not None:
        _state.run.cancel()
        _state.run, _state.has_begun = None, False


def end_session() -> None:
    """Leave nothing behind."""
    cancel()
    _state.device, _state.measured, _state.problem, _state.has_begun = {}, None, "", False
    _state.verdict = None
    use_costs(SHIPPED)
    take_verdict(Verdict())


def measured_costs() -> Costs | None:
    """Those in use where they were measured."""
    return None if _state.measured is None else _state.measured.costs


def rows() -> list[tuple[str, str]]:
    """For the preferences: which device, and when it was measured."""
    if not _state.device and not bpy.app.background:
        _look_up()
    run, measured, verdict = _state.run, _state.measured, _state.verdict
    when = "Not yet" if measured is None else measured.when.replace("T", " ")[:16]
    return [
        ("Device", _state.device.get("renderer", "Not used yet")),
        ("Driver", _state.device.get("version", "")),
        ("Measured", f"{run.label} ..." if run is not None else when),
        ("Results", "Not proven yet" if verdict is None else summary(verdict)),
    ]


def messages() -> list[str]:
    """What the user should know, one sentence each."""
    return [_state.problem] if _state.problem else []


def _file() -> Path | None:
    """Where costs are kept; None where the extension runs without being installed."""
    if not PACKAGE.startswith("bl_ext."):
        return None
    return Path(bpy.utils.extension_path_user(PACKAGE)) / FILE


def _look_up() -> None:
    """Take what is kept of the device."""
    _state.device = platform_facts()
    try:
        file = _file()
        _state.measured = None if file is None else read_kept(file, _state.device)
        _state.verdict = None if file is None else read_verdict(file, _state.device, versions())
    except InputError as error:
        _state.problem = str(error)
    if _state.verdict is not None:
        take_verdict(_state.verdict)
    use_costs(SHIPPED if _state.measured is None else _state.measured.costs)


def _begin(proves: bool, measures: bool) -> None:
    """What `auto` draws by is proven before it is measured, all else after that."""
    _state.is_asked = False
    tasks = [Task("Measuring this device", lambda: measure_costs(_found))] if measures else []
    if proves:
        first, others = (Task("Proving this device", partial(_prove, proofs)) for proofs in (FIRST, OTHERS))
        tasks = [first, *tasks, others]
    _state.run = SpreadRun(tasks)


def _prove(proofs: Sequence[Proof]) -> Iterator[None]:
    proving = Proving(proofs, None if proofs is FIRST else known_verdict())
    yield from proving.work()
    if proofs is FIRST:
        _take(proving.verdict)
    else:
        _proven(proving.verdict)


def _take(verdict: Verdict) -> None:
    """Use it. What was drawn and solved by a way that is left is let go, once this redraw is through."""
    if take_verdict(verdict) and not bpy.app.background:
        bpy.app.timers.register(forget_scenes)


def _proven(verdict: Verdict) -> None:
    _take(verdict)
    _state.verdict = verdict
    try:
        if (file := _file()) is not None:
            keep_verdict(file, _state.device, versions(), verdict)
    except InputError as error:
        _state.problem = f"What was proven of the device lasts until Blender ends: {error}"


def _found(costs: Costs, unrest: float) -> None:
    if unrest > MOST_UNREST and not _state.is_asked:
        _state.problem = (
            "The machine had other work while the device was measured: that is done again in the next session."
        )
        return
    _state.measured = Measured.now(costs)
    use_costs(costs)
    try:
        if (file := _file()) is not None:
            keep(file, _state.device, _state.measured)
    except InputError as error:
        _state.problem = f"What the device costs lasts until Blender ends: {error}"
