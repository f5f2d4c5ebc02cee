# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is found out about the device at its first use, a slice in each redraw of a view that rests, and kept.

Kept are the costs that `auto` counts with, in the extension's own folder of the user's, so that they are measured once
for each device and driver. In background nothing of all this is done unless it is asked for: there `auto` counts with
the costs that ship, the same on all machines that share a render.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import bpy

from ..errors import InputError
from ..options import PACKAGE
from ..output import checked_folder
from ..renderer.costs.table import SHIPPED, Costs, use_costs
from ..renderer.device.context import platform_facts, require_gpu
from ..renderer.measured.kept import Measured, forget, keep, read_kept
from ..renderer.measured.spread_run import SpreadRun, Task
from ..renderer.measured.unit_costs import measure_costs

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
    if measures and _state.measured is None and not _state.problem:
        try:
            if (file := _file()) is not None:
                checked_folder(file.parent)
                _begin()
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


def measure_now() -> str:
    """Measure at once, as the user asks; returns what is wrong, one sentence, or nothing. Costs are in use, and kept
    where there is a folder for them.

    Raises GpuUnavailableError without a GPU.
    """
    require_gpu()
    cancel()
    _state.device, _state.has_begun = platform_facts(), True
    _state.problem = ""
    _begin()
    _state.is_asked = True
    while is_running():
        advance()
    return _state.problem


def forget_device() -> str:
    """Count with the costs that ship, in this session, and keep nothing of the device; returns as `measure_now`.

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
    use_costs(SHIPPED)


def measured_costs() -> Costs | None:
    """Those in use where they were measured."""
    return None if _state.measured is None else _state.measured.costs


def rows() -> list[tuple[str, str]]:
    """For the preferences: which device, and when it was measured."""
    if not _state.device and not bpy.app.background:
        _look_up()
    run, measured = _state.run, _state.measured
    when = "Not yet" if measured is None else measured.when.replace("T", " ")[:16]
    return [
        ("Device", _state.device.get("renderer", "Not used yet")),
        ("Driver", _state.device.get("version", "")),
        ("Measured", f"{run.label} ..." if run is not None else when),
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
    except InputError as error:
        _state.problem = str(error)
    use_costs(SHIPPED if _state.measured is None else _state.measured.costs)


def _begin() -> None:
    _state.is_asked = False
    _state.run = SpreadRun([Task("Measuring this device", lambda: measure_costs(_found))])


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
