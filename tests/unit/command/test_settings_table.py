# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of settings: what it says holds together, what is out of range is refused, and the docs are its own."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import fields, replace
from math import inf, nan
from types import SimpleNamespace
from typing import Any

import bootstrap
import pytest
import write_settings
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics.catalog import METHODS
from curvrefl.curvrefl_addon.renderer.settings import Settings, check_settings
from curvrefl.curvrefl_addon.setting import Setting, value_of
from curvrefl.curvrefl_addon.settings_table import NAMED, OF_OBJECTS, OF_SCENES, RENDERER
from curvrefl.curvrefl_addon.ui.choices import PRESETS

SAVED_SETTINGS = {
    *("method", "pixel_tolerance", "samples", "bounces", "map_resolution", "motion_resolution", "environment"),
    *("environment_image", "environment_strength", "environment_rotation", "show", "stripe_count", "stripe_direction"),
    *("is_mirror", "override", "fresnel", "tint", "ior"),
}
SAVED_CHOICES = {
    "method": (
        *("auto", "exact", "secant_star", "newton", "secant_uv", "bisector_cube", "bisector_grid", "bisector_screen"),
        *("planar", "environment_cube", "environment_cube_vertex", "environment_sphere", "environment_parallax"),
    ),
    "motion_resolution": ("FULL", "HALF", "QUARTER"),
    "environment": ("VIEWPORT", "SCENE", "IMAGE"),
    "show": ("REFLECTION", "ITERATIONS", "STATUS", "ANGLE_ERROR", "METHOD", "ZEBRA", "LINES"),
    "fresnel": ("METAL", "DIELECTRIC", "CONSTANT"),
}
"""Of version 0.1, in the order of the menus"""


def test_the_page_of_settings_is_written_from_the_table() -> None:
    assert write_settings.PAGE.read_text(encoding="utf-8") == write_settings.page(), (
        "the table has changed: call tools/write_settings.py"
    )


@pytest.mark.parametrize("item", NAMED.values(), ids=NAMED)
def test_defaults_and_sliders_are_in_range(item: Setting) -> None:
    if not isinstance(item.start, tuple):
        for value in (item.default, item.start, *(item.flag_value(flag) for flag in item.flags)):
            item.check(value)
        for end in item.soft:
            if end is not None:
                item.check(end)
    assert item.name not in {"", "setting"}
    assert type(item.start) is type(item.default)


def test_files_saved_before_find_their_settings() -> None:
    """A file keeps properties by name, and of a menu the place."""
    assert {item.name for item in OF_SCENES + OF_OBJECTS} >= SAVED_SETTINGS
    for name, saved in SAVED_CHOICES.items():
        choices = tuple(choice.name for choice in NAMED[name].choices)
        assert choices[: len(saved)] == saved, name


def test_presets_are_values_of_settings_of_scenes() -> None:
    names = {item.name for item in OF_SCENES}
    for _, _, values in PRESETS.values():
        assert values.keys() <= names
        for name, value in values.items():
            NAMED[name].check(value)


def test_every_field_of_the_settings_is_in_the_table() -> None:
    assert [item.name for item in RENDERER] == [field.name for field in fields(Settings)]
    check_settings(Settings())


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("method", "magic", f'There is no method "magic": choose one of {", ".join(METHODS)}.'),
        ("samples", 0, "0 samples are out of range: choose 1 to 1024."),
        ("samples", 1025, "1025 samples are out of range: choose 1 to 1024."),
        ("pixel_tolerance", 0.009, "A tolerance of 0.009 pixels is out of range: choose 0.01 to 100."),
        ("pixel_tolerance", nan, "A tolerance of nan pixels is out of range: choose 0.01 to 100."),
        ("pixel_tolerance", inf, "A tolerance of inf pixels is out of range: choose 0.01 to 100."),
        ("map_resolution", 7, "A map of 7 texels is out of range: choose 8 to 2048."),
        ("environment_resolution", 4097, "An environment map of 4097 texels is out of range: choose 8 to 4096."),
        ("bounces", 65, "65 bounces are out of range: choose 1 to 64."),
        ("steps", -1, "-1 search steps are out of range: choose 0 (the method's own) to 1000."),
        ("grid_share", 0.0, "A grid share of 0.0 is out of range: choose more than 0, at most 1."),
        ("grid_share", 1.1, "A grid share of 1.1 is out of range: choose more than 0, at most 1."),
        ("frustum", 0.5, "A frustum factor of 0.5 is out of range: choose 1 to 4."),
        ("search_resolution", 5.0, "A search resolution of 5.0 texels per pixel is out of range: choose 0.1 to 4."),
    ],
)
def test_what_is_out_of_range_is_refused_in_one_sentence(name: str, value: Any, sentence: str) -> None:
    with pytest.raises(InputError) as refused:
        check_settings(replace(Settings(), **{name: value}))
    assert str(refused.value) == sentence


def test_a_range_may_have_one_end() -> None:
    strength, unknown = NAMED["environment_strength"], Setting(label="Gain", text="", hard=(None, 3))
    strength.check(1e9)
    unknown.check(-1e9)
    with pytest.raises(InputError, match="A value of -1 for Strength is out of range: choose 0 or more"):
        strength.check(-1)
    with pytest.raises(InputError, match="A value of 4 for Gain is out of range: choose at most 3"):
        unknown.check(4)


def test_a_choice_that_is_unknown_here_reads_as_the_start() -> None:
    """Blender gives nothing for a place that a menu does not have."""
    owner = SimpleNamespace(method="", samples=3, environment_image=None)
    assert value_of(owner, NAMED["method"]) == "auto"
    assert value_of(owner, NAMED["samples"]) == 3
    assert value_of(owner, NAMED["environment_image"]) is None


@pytest.mark.parametrize(
    ("verb", "expected"),
    [("compare", {}), ("bake", {})],
)
def test_without_arguments_a_verb_has_the_tables_values(
    verb: str, expected: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[Settings] = []

    def record(options: Any) -> int:
        seen.append(cli.verbs.chosen_settings(options))
        return 0

    monkeypatch.setattr(cli.verbs, verb, record)
    assert cli.main([verb, "x.blend", "--reflector", "A", "--output", "x.png"]) == 0
    assert seen == [replace(Settings(), **expected)]


def test_the_table_needs_neither_blender_nor_numpy() -> None:
    program = (
        "import sys; sys.path.insert(0, 'tools'); import bootstrap; bootstrap.load_package()\n"
        "import curvrefl.curvrefl_addon.settings_table\n"
        "assert not {'bpy', 'gpu', 'numpy', 'curvrefl.curvrefl_addon.renderer'} & set(sys.modules)"
    )
    result = subprocess.run([sys.executable, "-c", program], cwd=bootstrap.ROOT, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
