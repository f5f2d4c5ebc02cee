# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Devices that compute something wrongly: the GLSL that they run is another one."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from unittest.mock import patch

from curvrefl.curvrefl_addon.gpu_caches import clear_gpu_caches
from curvrefl.curvrefl_addon.renderer.device import shaders
from curvrefl.gpu_shaders.loader import Part, Source, load


@contextmanager
def broken(text: str, wrong: str) -> Iterator[None]:
    """Shaders that have `text` have `wrong` in its place. Raises AssertionError where none has."""
    met = []

    def wrongly(*parts: Part) -> Source:
        source = load(*parts)
        met.append(text in source.text)
        return replace(source, text=source.text.replace(text, wrong))

    clear_gpu_caches()
    try:
        with patch.object(shaders, "load", wrongly):
            yield
    finally:
        clear_gpu_caches()
    assert any(met), f"no shader has {text}"


def by_compute(text: str, wrong: str) -> tuple[str, str]:
    """For `broken`: wrong in compute shaders alone."""
    return text, f"\n#ifdef BY_FRAGMENTS\n{text}\n#else\n{wrong}\n#endif\n"
