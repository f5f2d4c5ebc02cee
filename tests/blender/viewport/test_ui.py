# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings, presets and operators: what they are set to, what they change, and what their tooltips say."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon import options, registration, settings_table
from curvrefl.curvrefl_addon.renderer.settings import Settings, check_settings
from curvrefl.curvrefl_addon.setting import Choice, Setting
from curvrefl.curvrefl_addon.ui import choices, panel, preferences, properties, table_properties
from curvrefl.operators.mirror_settings import CURVREFL_OT_apply_preset, CURVREFL_OT_toggle_mirror
from viewport.layouts import add_cubes, context, draw

pytestmark = pytest.mark.usefixtures("registered")


def test_defaults_are_those_of_the_balanced_preset() -> None:
    assert choices.active_preset(bpy.context.scene.curvrefl) == "BALANCED"
    assert options.current_options() == options.Options()


@pytest.mark.parametrize("name", choices.PRESETS)
def test_a_preset_sets_what_it_says(name: str) -> None:
    settings = bpy.context.scene.curvrefl
    settings.pixel_tolerance = 7.0
    assert choices.active_preset(settings) == ""
    assert bpy.ops.curvrefl.apply_preset(preset=name) == {"FINISHED"}
    assert choices.active_preset(settings) == name
    for key, value in choices.PRESETS[name][2].items():
        assert getattr(settings, key) == pytest.approx(value)


def test_changes_of_data_can_be_undone() -> None:
    for operator in (CURVREFL_OT_apply_preset, CURVREFL_OT_toggle_mirror):
        assert "UNDO" in operator.bl_options


def test_toggle_makes_all_selected_what_the_active_one_was_not() -> None:
    first, second, third = add_cubes(3)
    second.curvrefl.is_mirror = True
    third.select_set(False)
    assert bpy.ops.curvrefl.toggle_mirror() == {"FINISHED"}
    assert [first.curvrefl.is_mirror, second.curvrefl.is_mirror, third.curvrefl.is_mirror] == [True, True, False]
    bpy.ops.curvrefl.toggle_mirror()
    assert not options.marked_mirrors(bpy.context.scene)


def test_toggle_needs_a_surface() -> None:
    assert not bpy.ops.curvrefl.toggle_mirror.poll()
    bpy.ops.object.light_add()
    assert not bpy.ops.curvrefl.toggle_mirror.poll()
    add_cubes(1)
    assert bpy.ops.curvrefl.toggle_mirror.poll()


def test_only_settings_that_nobody_touched_follow_the_preferences(monkeypatch: pytest.MonkeyPatch) -> None:
    first = options.Options().new_scenes | {"samples": 3, "map_resolution": 64}
    monkeypatch.setattr(properties, "current_options", lambda: options.Options(new_scenes=first))
    scene = bpy.context.scene
    scene.curvrefl.samples = 20
    properties.use_defaults()
    assert (scene.curvrefl.samples, scene.curvrefl.map_resolution) == (20, 64)
    assert scene.curvrefl.version == options.SETTINGS_VERSION
    # Once used, a scene keeps what it has.
    scene.curvrefl.property_unset("map_resolution")
    properties.use_defaults()
    assert scene.curvrefl.map_resolution == 128


def test_settings_of_a_newer_extension_are_told_of() -> None:
    scene = bpy.context.scene
    assert not options.newer_settings(scene)
    scene.curvrefl.version = options.SETTINGS_VERSION + 1
    sentence = options.newer_settings(scene)
    assert sentence
    assert sentence in " ".join(draw(panel.CURVREFL_PT_main, context()).texts)


def test_a_method_of_a_newer_extension_reads_as_automatic(tmp_path: Path) -> None:
    """Saved by an extension with one method more, in scene and preferences."""
    later = (*settings_table.METHOD_CHOICES, Choice("magic", "Magic", "Of a later day"))
    newer = tuple(replace(item, choices=later) if item.name == "method" else item for item in settings_table.OF_SCENES)
    path = str(tmp_path / "newer.blend")
    registration.unregister()
    group: Any = type(
        "CurvreflScene", (bpy.types.PropertyGroup,), {"__annotations__": table_properties.properties_of(newer)}
    )
    bpy.utils.register_class(group)
    bpy.types.Scene.curvrefl = bpy.props.PointerProperty(type=group)
    try:
        bpy.context.scene.curvrefl.method = "magic"
        bpy.context.scene.curvrefl.bounces = 7
        bpy.ops.wm.save_as_mainfile(filepath=path)
    finally:
        del bpy.types.Scene.curvrefl
        bpy.utils.unregister_class(group)
        registration.register()
    bpy.ops.wm.open_mainfile(filepath=path)
    chosen = bpy.context.scene.curvrefl
    assert chosen.method == ""
    assert options.settings_of(chosen) == Settings(method="auto", samples=8, bounces=7)
    check_settings(options.settings_of(chosen))


def test_ends_of_the_sliders_are_in_the_renderers_range() -> None:
    """Blender keeps 0.01 as a float32 that is less."""
    chosen = bpy.context.scene.curvrefl
    for extreme in (-1e6, 1e6):
        for name in ("pixel_tolerance", "samples", "bounces", "map_resolution"):
            setattr(chosen, name, type(getattr(chosen, name))(extreme))
        check_settings(options.settings_of(chosen))


def test_properties_have_the_ranges_and_defaults_of_the_table() -> None:
    groups = (
        (properties.CurvreflScene, settings_table.OF_SCENES),
        (properties.CurvreflObject, settings_table.OF_OBJECTS),
        (preferences.CurvreflPreferences, settings_table.OF_NEW_SCENES + settings_table.OF_PREFERENCES),
    )
    for group, settings in groups:
        found = group.bl_rna.properties
        for item in settings:
            known = found[item.name]
            assert (known.name, known.type) == (item.label, _type(item)), item.name
            if item.choices:
                assert [entry.identifier for entry in known.enum_items] == [choice.name for choice in item.choices]
            if isinstance(item.start, bool | int | float | str):
                assert known.default == pytest.approx(item.start), item.name
            if item.hard[1] is not None:
                assert (known.hard_min, known.hard_max) == pytest.approx(item.hard), item.name
            if item.soft[1] is not None:
                assert known.soft_max == pytest.approx(item.soft[1]), item.name


def _type(item: Setting) -> str:
    if item.start is None:
        return "POINTER"
    if item.choices:
        return "ENUM"
    return {bool: "BOOLEAN", int: "INT"}.get(type(item.start), "FLOAT")


def _groups() -> list[Any]:
    operators = [cls for name in registration.OPERATORS for cls in registration._module(f"operators.{name}").CLASSES]
    return [
        properties.CurvreflObject.bl_rna,
        properties.CurvreflScene.bl_rna,
        preferences.CurvreflPreferences.bl_rna,
        *(getattr(bpy.ops.curvrefl, cls.bl_idname.partition(".")[2]).get_rna_type() for cls in operators),
    ]


def test_everything_has_a_tooltip_without_a_period() -> None:
    bad = []
    for group in _groups():
        for item in group.properties:
            if item.identifier in {"rna_type", "name", "bl_idname"} or item.is_hidden:
                continue
            tips = {item.identifier: item.description}
            if item.type == "ENUM":
                tips |= {f"{item.identifier}.{choice.identifier}": choice.description for choice in item.enum_items}
            bad += [
                (group.identifier, name, tip)
                for name, tip in tips.items()
                if not tip or tip.endswith(".") or tip[0] != tip[0].upper()
            ]
    assert not bad, bad
