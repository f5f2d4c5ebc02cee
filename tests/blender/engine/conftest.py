# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension, registered as Blender does it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from curvrefl.curvrefl_addon import registration


@pytest.fixture
def extension(gpu: None) -> Iterator[None]:
    registration.register()
    yield
    registration.unregister()
