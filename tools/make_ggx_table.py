# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Integrates the GGX table anew and writes it where the renderer loads it.

python tools/make_ggx_table.py
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bootstrap

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer.lighting.ggx import TABLE_FILE, integrate_ggx  # noqa: E402

if __name__ == "__main__":
    np.save(TABLE_FILE, integrate_ggx().astype(np.float16))
