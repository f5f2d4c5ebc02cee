# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings, presets, menus, and panels drawn into a layout that only listens."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.options import SETTINGS_VERSION, Options, current_options
from curvrefl.curvrefl_addon.ui import menus, panel
from curvrefl.curvrefl_addon.ui.choices import PRESETS, active_preset
from curvrefl.curvrefl_addon.ui.messages import wrapped
from curvrefl.curvrefl_addon.ui.properties import use_defaults


@pytest.fixture(autouse=True)
def scene() -> Iterator[None]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    registration.register()
    for name in ("first", "second"):
        bpy.ops.mesh.primitive_cube_add()
        bpy.context.object.name = name
    yield
    registration.unregister()


class Layout:
    """Takes every call of a panel's layout; remembers texts and properties."""

    def __init__(self, said: list[str] | None = None) -> None:
        self.said = [] if said is None else said

    def __getattr__(self, name: str) -> Any:
        def call(*arguments: Any, **named: Any) -> Any:
            if name == "prop":
                owner, key = arguments[:2]
                assert key in owner.bl_rna.properties, key
                self.said.append(named.get("text", key))
            if name == "operator":
                assert hasattr(bpy.types, "CURVREFL_OT_" + arguments[0].removeprefix("curvrefl.")), arguments[0]
            if name == "menu":
                assert hasattr(bpy.types, arguments[0])
            if named.get("text"):
                self.said.append(named["text"])
            return Layout(self.said)

        return call


class Context:
    """bpy.context with a region."""

    region = type("Region", (), {"width": 280})()

    def __getattr__(self, name: str) -> Any:
        return getattr(bpy.context, name)


def drawn(cls: type) -> list[str]:
    """What a panel shows."""
    layout = Layout()
    shown = type("Shown", (), {"layout": layout})()
    context = Context()
    if hasattr(cls, "poll") and not cls.poll(context):  # type: ignore[attr-defined]
        return []
    for name in ("draw_header", "draw_header_preset", "draw"):
        if hasattr(cls, name):
            getattr(cls, name)(shown, context)
    return layout.said


def test_panels_draw_in_every_state() -> None:
    def all_panels() -> str:
        return " ".join(text for cls in panel.CLASSES for text in drawn(cls))

    assert "No object is marked as a mirror" in all_panels()
    bpy.context.object.curvrefl.is_mirror = True
    assert "Override Material" not in all_panels() and "Switched off: tick the" in all_panels()
    for show in ("ZEBRA", "STATUS"):
        bpy.context.scene.curvrefl.show = show
        assert ("stripe_count" in all_panels()) == (show == "ZEBRA")
    bpy.context.scene.curvrefl.environment = "IMAGE"
    assert "environment_strength" in all_panels()
    bpy.context.scene.curvrefl.version = 1000
    assert "saved with a newer Curvrefl" in all_panels()
    bpy.context.view_layer.objects.active = None
    assert "Select an object" in all_panels()
    bpy.ops.object.camera_add()
    assert "has no surface" in all_panels()


def test_menus_draw() -> None:
    layout = Layout()
    shown = type("Shown", (), {"layout": layout})()
    menus.CURVREFL_MT_presets.draw(shown, Context())  # type: ignore[arg-type]
    menus.draw_object_entry(shown, Context())  # type: ignore[arg-type]
    menus.draw_overlay_entry(shown, Context())  # type: ignore[arg-type]
    assert {"Fast", "Balanced", "Exact", "Curvrefl", "curvrefl_enabled"} <= set(layout.said)


def test_presets_set_what_they_say() -> None:
    settings = bpy.context.scene.curvrefl
    for name, (_, _, values) in PRESETS.items():
        assert bpy.ops.curvrefl.apply_preset(preset=name) == {"FINISHED"}
        assert active_preset(settings) == name
        for key, value in values.items():
            assert getattr(settings, key) == pytest.approx(value) if isinstance(value, float) else value
    settings.samples = 3
    assert active_preset(settings) == ""


def test_defaults_are_a_preset() -> None:
    assert active_preset(bpy.context.scene.curvrefl) == "BALANCED"
    assert current_options() == Options()


def test_toggle_marks_all_selected_and_takes_one_undo() -> None:
    for obj in bpy.context.scene.objects:
        obj.select_set(True)
    assert bpy.ops.curvrefl.toggle_mirror() == {"FINISHED"}
    assert all(obj.curvrefl.is_mirror for obj in bpy.context.scene.objects)
    assert bpy.ops.curvrefl.toggle_mirror() == {"FINISHED"}
    assert not any(obj.curvrefl.is_mirror for obj in bpy.context.scene.objects)
    for obj in bpy.context.scene.objects:
        obj.select_set(False)
    with pytest.raises(RuntimeError, match="poll"):
        bpy.ops.curvrefl.toggle_mirror()
    for operator in ("toggle_mirror", "apply_preset"):
        assert "UNDO" in getattr(bpy.types, f"CURVREFL_OT_{operator}").bl_options
    for operator in ("save_preview", "compare_with_cycles", "trace_at_cursor", "clear_trace", "bake_reflector"):
        assert "UNDO" not in getattr(bpy.types, f"CURVREFL_OT_{operator}").bl_options


def test_preferences_reach_new_scenes_only(monkeypatch: pytest.MonkeyPatch) -> None:
    from curvrefl.curvrefl_addon.ui import properties

    monkeypatch.setattr(properties, "current_options", lambda: Options(samples=3, pixel_tolerance=1.5))
    chosen = bpy.context.scene.curvrefl
    chosen.pixel_tolerance = 0.25
    use_defaults()
    assert (chosen.samples, chosen.pixel_tolerance, chosen.version) == (3, 0.25, SETTINGS_VERSION)
    chosen.property_unset("samples")
    use_defaults()
    assert chosen.samples == 8, "a scene that has been in use is left alone"


def test_every_setting_has_a_tooltip() -> None:
    for group in (bpy.types.Object, bpy.types.Scene):
        for name, item in group.bl_rna.properties["curvrefl"].fixed_type.properties.items():
            if name not in ("rna_type", "name", "version"):
                assert item.description and not item.description.endswith("."), name


def test_long_messages_wrap_at_words() -> None:
    text = "one two three four five"
    assert wrapped(text, 9) == ["one two", "three", "four five"]
    assert wrapped("unbreakable", 4) == ["unbreakable"]
