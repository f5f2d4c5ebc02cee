# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirrors follow each other as often as the file's own renders let them: whole pictures against Cycles."""

from __future__ import annotations

from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon.demo.data_blocks import add_object, principled
from curvrefl.curvrefl_addon.demo.shapes import box
from lighting.room import build_room, judge_room

pytestmark = pytest.mark.usefixtures("gpu")

MIRRORS = ("mirror", "cube", "gloss")


def three_mirrors(glossy: int) -> None:
    """And a small block that shines."""
    scene: Any = build_room()
    for name in MIRRORS[1:]:
        thing: Any = bpy.data.objects[name]
        thing.data.materials[0] = bpy.data.materials["chrome"]
    shining = principled("shining", (0.9, 0.6, 0.1), emission=(0.5, 0.3, 0.05))
    add_object("block", box((0.5, 0.5, 0.5)), shining, location=(0.1, -2.6, 0.25))
    scene.cycles.glossy_bounces = glossy


@pytest.mark.parametrize("glossy", [0, 1, 2])
def test_mirrors_end_where_the_files_renders_do(glossy: int) -> None:
    three_mirrors(glossy)
    judged = judge_room(mirrors=MIRRORS)
    assert judged.share_off < 0.02
    assert not judged.warnings


@pytest.mark.parametrize("glossy", [0, 2])
def test_mirrors_that_end_need_no_shadow_rays(glossy: int) -> None:
    """What follows no more mirrors has no lamps to shadow either."""
    three_mirrors(glossy)
    judged = judge_room(mirrors=MIRRORS, shadow_rays=True)
    assert judged.share_off < 0.02


def test_without_glossy_bounces_solved_vertices_are_dark_too() -> None:
    build_room().cycles.max_bounces = 0
    judged = judge_room(method="newton")
    assert judged.share_off < 0.02
    # Of the mirror's lower half, the floor.
    assert judged.ours[22:28, 46:52].mean() < 0.02
