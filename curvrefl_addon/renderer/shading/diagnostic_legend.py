# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws legends into the lower corners of a region (in a POST_PIXEL handler)."""

from __future__ import annotations

from dataclasses import dataclass

import blf
import bpy
import mathutils

from ...diagnostics.colors import Color, Legend, ramp_colors
from ..device.overlays import draw_boxes
from ..device.state import blended

FONT = 0
TEXT, PADDING, MARGIN, GAP = 11.0, 10.0, 16.0, 6.0
"""Pixels at a resolution scale of 1"""
BAR_WIDTH, BAR_HEIGHT, SWATCH = 220.0, 12.0, 12.0
BAR_CELLS = 48
_PANEL = (0.05, 0.05, 0.05, 0.8)
_INK = (0.9, 0.9, 0.9, 1.0)

type _Box = tuple[float, float, float, float]
"""x, y, width, height"""


@dataclass(frozen=True, slots=True)
class Layout:
    """Where a legend's parts go, pixels from the region's lower left corner."""

    panel: _Box
    colors: tuple[tuple[_Box, Color], ...]
    """Swatches, and the cells of the ramp"""
    texts: tuple[tuple[float, float, str], ...]
    """x and y of the base line's left end"""


def draw_legend(legend: Legend, context: bpy.types.Context, at_left: bool = False) -> None:
    """Draw beside the sidebar of the context's 3D viewport, or beside its toolbar."""
    region, area, preferences = context.region, context.area, context.preferences
    if region is None or area is None or preferences is None:
        return
    scale = preferences.system.ui_scale
    left = right = bottom = 0.0
    if preferences.system.use_region_overlap:
        for other in area.regions:
            if other.type == "UI" and other.alignment == "RIGHT" and other.width > 1:
                right += other.width
            if other.type == "TOOLS" and other.alignment == "LEFT" and other.width > 1:
                left += other.width
            if other.type.startswith("ASSET_SHELF") and other.alignment == "BOTTOM" and other.height > 1:
                bottom += other.height
    placed = layout_at_left if at_left else layout
    draw_layout(placed(legend, left if at_left else region.width - right, bottom, scale), scale)


def layout(legend: Legend, right: float, bottom: float, scale: float = 1.0) -> Layout:
    """Place a legend so that its lower right corner is a margin away from (right, bottom); `scale` is Blender's."""
    blf.size(FONT, TEXT * scale)
    text, padding, gap = TEXT * scale, PADDING * scale, GAP * scale
    bar_width, bar_height, swatch = BAR_WIDTH * scale, BAR_HEIGHT * scale, SWATCH * scale
    widths = [blf.dimensions(FONT, legend.title)[0]]
    widths += [swatch + gap + blf.dimensions(FONT, label)[0] for _, label in legend.swatches]
    # The last tick's text hangs over the end of the ramp.
    widths += [bar_width + blf.dimensions(FONT, label)[0] / 2 for _, label in legend.ticks[-1:]]
    # A little more room under the title.
    height = text + gap / 2 + len(legend.swatches) * (swatch + gap)
    if legend.ramp:
        height += gap + bar_height + gap + text
    panel_width = max(widths) + 2 * padding
    panel_height = height + 2 * padding
    x, y = right - MARGIN * scale - panel_width, bottom + MARGIN * scale
    panel = (x, y, panel_width, panel_height)

    colors: list[tuple[_Box, Color]] = []
    x += padding
    top = y + panel_height - padding - text
    texts = [(x, top, legend.title)]
    top -= gap / 2
    if legend.ramp:
        top -= gap + bar_height
        cell = bar_width / BAR_CELLS
        for i, color in enumerate(ramp_colors(legend.ramp, BAR_CELLS).tolist()):
            colors.append(((x + i * cell, top, cell, bar_height), color))
        top -= gap + text
        for part, label in legend.ticks:
            half = blf.dimensions(FONT, label)[0] / 2
            texts.append((max(x + part * bar_width - half, x), top, label))
    for color, label in legend.swatches:
        top -= gap + swatch
        colors.append(((x, top, swatch, swatch), color))
        texts.append((x + swatch + gap, top + 0.15 * swatch, label))
    return Layout(panel, tuple(colors), tuple(texts))


def layout_at_left(legend: Legend, left: float, bottom: float, scale: float = 1.0) -> Layout:
    """As `layout`: the lower left corner is a margin away from (left, bottom)."""
    width = layout(legend, 0.0, bottom, scale).panel[2]
    return layout(legend, left + width + 2.0 * MARGIN * scale, bottom, scale)


def draw_layout(placed: Layout, scale: float = 1.0) -> None:
    """Draw with the matrices of a POST_PIXEL handler: one unit is a pixel."""
    with blended("ALPHA"):
        draw_boxes([(placed.panel, _PANEL)] + [(box, _on_screen(color)) for box, color in placed.colors])
        blf.size(FONT, TEXT * scale)
        blf.color(FONT, *_INK)
        for x, y, text in placed.texts:
            blf.position(FONT, x, y, 0.0)
            blf.draw(FONT, text)


def _on_screen(color: Color) -> tuple[float, float, float, float]:
    """sRGB, as Blender's own shaders take colors."""
    encoded = mathutils.Color(color).from_scene_linear_to_srgb()
    return (encoded.r, encoded.g, encoded.b, 1.0)
