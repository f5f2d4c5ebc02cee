# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Script: what an artist's session imports, printed as a list of module names."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import bpy  # noqa: F401  (before gpu)

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))

import bootstrap

bootstrap.load_package()

import curvrefl  # noqa: E402

curvrefl.register()

import curvrefl.curvrefl_addon.renderer.renderer  # noqa: E402
import curvrefl.curvrefl_addon.viewport.handlers  # noqa: E402

print("IMPORTED " + json.dumps([name for name in sys.modules if name.startswith("curvrefl.")]))
curvrefl.unregister()
