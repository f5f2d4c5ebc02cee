# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the repository importable as the package `curvrefl`, whatever its folder is called.

Inside Blender the same files are the package `bl_ext.<repository>.curvrefl`; both use relative imports only.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def load_package() -> None:
    """Put `curvrefl` into sys.modules. `bpy` must be imported first where `gpu` will be used."""
    if "curvrefl" in sys.modules:
        return
    spec = importlib.util.spec_from_file_location(
        "curvrefl", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["curvrefl"] = module
    spec.loader.exec_module(module)
