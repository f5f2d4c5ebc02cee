# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Letting go of what functions keep with `functools.cache`: shaders and batches above all.

Blender crashes at its end when such objects outlive its GPU context.
"""

from __future__ import annotations

import sys

_OURS = f"{__package__}."


def clear_gpu_caches() -> None:
    """Empty the caches of all our modules that are loaded; they fill again when used."""
    for name, module in list(sys.modules.items()):
        if name.startswith(_OURS):
            for value in list(vars(module).values()):
                if callable(clear := getattr(value, "cache_clear", None)):
                    clear()
