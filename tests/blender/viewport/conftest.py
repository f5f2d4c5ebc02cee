# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An empty file and the extension in it."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
import pytest
from curvrefl.curvrefl_addon import registration


@pytest.fixture
def registered() -> Iterator[None]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    registration.register()
    yield
    registration.unregister()
