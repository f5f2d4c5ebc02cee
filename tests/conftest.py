# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the repository importable as `curvrefl`; gives tests of the layers above unit a GPU or a reason to skip."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

try:
    import bpy
except ImportError:
    HAS_BLENDER = False
else:
    HAS_BLENDER = True

try:
    from hypothesis import settings
except ImportError:
    # Tests that need it skip themselves.
    pass
else:
    # The same cases every time, and no clock: a test fails for what changed, not for a busy machine.
    settings.register_profile("repeatable", deadline=None, derandomize=True)
    settings.load_profile("repeatable")

# The supervisor of a run of the tests is not that of the verbs that they call.
os.environ.pop("CURVREFL_RUN", None)

TESTS = Path(__file__).resolve().parent
# Helpers beside the tests that use them, those of a room as `room.helper`; tests/scenes is a package of scene builders.
sys.path[:0] = [str(TESTS.parent / "tools"), str(TESTS), str(TESTS / "blender")]

import bootstrap  # noqa: E402

bootstrap.load_package()

if HAS_BLENDER:

    @bpy.app.handlers.persistent
    def _in_direct_light(_path: str) -> None:
        """Scenes that tests make have no bounced light but where it is what they are about: most judge other things,
        and patches take their time."""
        for scene in bpy.data.scenes if not bpy.data.filepath else ():
            if hasattr(scene, "cycles"):
                scene.cycles.diffuse_bounces = 0

    bpy.app.handlers.load_post.append(_in_direct_light)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """What stays in one process where pytest runs in several: a file, for its fixtures; all windows, for the screen."""
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = super()._split_scope(nodeid)
            return "tests/gui" if file.startswith("tests/gui/") else file

        def remove_node(self, node: Any) -> str | None:
            """The test that a process died of has failed and is not tried again; the rest of its file is."""
            units = self.assigned_work.pop(node, {})
            left = [(unit, test) for unit in units.values() for test, is_done in unit.items() if not is_done]
            if not left:
                return None
            unit, crashed = left[0]
            unit[crashed] = True
            self.workqueue.update({name: unit for name, unit in units.items() if not all(unit.values())})
            for other in list(self.assigned_work):
                self._reschedule(other)
            return crashed

    return Scheduling(config, log)


def _gpu_missing() -> str:
    """Why there is no GPU context, or nothing when there is one."""
    if not HAS_BLENDER:
        return "this Python has no Blender (bpy)"
    from curvrefl.curvrefl_addon.renderer.device.context import GpuUnavailableError, require_gpu

    try:
        require_gpu()
    except GpuUnavailableError as error:
        return str(error)
    return ""


@pytest.fixture(scope="session")
def gpu() -> Iterator[None]:
    """A GPU context; without one the test is skipped, with the reason."""
    reason = _gpu_missing()
    if reason:
        pytest.skip(reason)
    yield
    # What is left must go while the context is there.
    from curvrefl.curvrefl_addon.gpu_caches import clear_gpu_caches

    clear_gpu_caches()
    gc.collect()
