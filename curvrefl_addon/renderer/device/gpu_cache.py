# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeping shaders and batches, apart for the viewports and for a render that runs beside them.

A shader holds its constants between two draws, and a batch belongs to the context that drew it last. In a window
Blender renders in a thread and a context of its own while the viewports draw in the main thread: each has its own.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import cache, wraps
from typing import Any


def gpu_cache(make: Callable[..., Any]) -> Callable[..., Any]:
    """`functools.cache` for what is the GPU's; one render at a time may run beside the main thread."""
    of_main, of_render = cache(make), cache(make)

    @wraps(make)
    def kept(*arguments: Any) -> Any:
        return (of_main if in_main_thread() else of_render)(*arguments)

    def clear() -> None:
        of_main.cache_clear()
        of_render.cache_clear()

    kept.cache_clear = clear  # type: ignore[attr-defined]
    return kept


def in_main_thread() -> bool:
    """Where viewports are drawn, and all in background."""
    return threading.current_thread() is threading.main_thread()
