# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences in a panel, over as many lines as it is wide, and rows of figures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy

LETTER_PIXELS = 7.0
"""Mean width of a letter at the default interface scale"""
FEWEST_LETTERS = 20


def draw_message(layout: Any, text: str, context: bpy.types.Context, icon: str = "ERROR") -> None:
    """One sentence, wrapped."""
    # (0 without a window)
    scale = context.preferences.system.ui_scale or 1.0
    letters = max(int((context.region.width / scale - 40.0) / LETTER_PIXELS), FEWEST_LETTERS)
    column = layout.column(align=True)
    for line in wrapped(text, letters):
        column.label(text=line, icon=icon)
        icon = "BLANK1"


def wrapped(text: str, letters: int) -> list[str]:
    """The text in lines of at most so many letters, or of one longer word."""
    lines = [""]
    for word in text.split():
        if lines[-1] and len(lines[-1]) + len(word) + 1 > letters:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return lines


def draw_rows(layout: Any, rows: Sequence[tuple[str, str]]) -> None:
    """Label and value next to each other."""
    split = layout.split(factor=0.45)
    labels, values = split.column(align=True), split.column(align=True)
    labels.alignment = "RIGHT"
    for label, value in rows:
        labels.label(text=label)
        values.label(text=value)
