# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels and menus draw in every state."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon.engine import panels as engine_panels
from curvrefl.curvrefl_addon.ui import choices, menus, messages, panel, preferences, render_panels
from curvrefl.curvrefl_addon.viewport import handlers as viewport
from viewport.layouts import Layout, add_cubes, context, draw

pytestmark = pytest.mark.usefixtures("registered")
ENTRIES = {
    "VIEW3D_MT_object_context_menu": menus.draw_object_entry,
    "VIEW3D_MT_object": menus.draw_object_entry,
    "VIEW3D_PT_overlay": menus.draw_overlay_entry,
}


def _no_scene() -> Any:
    return context(scene=None, object=None)


def _nothing() -> Any:
    return context()


def _light() -> Any:
    bpy.ops.object.light_add()
    return context()


def _plain_mesh() -> Any:
    add_cubes(1)
    return context()


def _mirror(**settings: Any) -> Any:
    (cube,) = add_cubes(1)
    cube.curvrefl.is_mirror = True
    for name, value in settings.items():
        setattr(cube.curvrefl, name, value)
    return context()


def _glass() -> Any:
    return _mirror(override=True, fresnel="DIELECTRIC")


def _many_hidden() -> Any:
    for cube in add_cubes(panel.MOST_LISTED + 3):
        cube.curvrefl.is_mirror = True
        cube.hide_set(True)
    return context()


def _stripes() -> Any:
    bpy.context.scene.curvrefl.show = "ZEBRA"
    bpy.context.scene.curvrefl.environment = "IMAGE"
    return _mirror()


STATES = (_no_scene, _nothing, _light, _plain_mesh, _mirror, _glass, _many_hidden, _stripes)


@pytest.mark.parametrize("state", STATES, ids=lambda state: state.__name__)
def test_every_panel_and_menu_draws(state: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    seen = state()
    for found in ([], ["Two sentences. They are long enough to need more than one line of the panel."]):
        monkeypatch.setattr(viewport, "messages", lambda found=found: found)
        for cls in panel.CLASSES:
            draw(cls, seen)
        for entry in set(ENTRIES.values()):
            entry(SimpleNamespace(layout=Layout()), seen)
    if seen.scene is not None:
        menu = Layout()
        menus.CURVREFL_MT_presets.draw(SimpleNamespace(layout=menu), seen)
        assert menu.shown == ["curvrefl.apply_preset"] * len(choices.PRESETS)
    preferences.CurvreflPreferences.draw(
        SimpleNamespace(layout=Layout(), bl_rna=preferences.CurvreflPreferences.bl_rna), seen
    )


def test_the_mirror_panel_is_for_mirrors_alone() -> None:
    assert draw(panel.CURVREFL_PT_mirror, _nothing()) is None
    assert draw(panel.CURVREFL_PT_mirror, _plain_mesh()) is None
    bpy.context.object.curvrefl.is_mirror = True
    metal = draw(panel.CURVREFL_PT_mirror, context())
    assert {"override", "fresnel", "tint", "curvrefl.bake_reflector"} <= set(metal.shown) and "ior" not in metal.shown
    bpy.context.object.curvrefl.fresnel = "DIELECTRIC"
    glass = draw(panel.CURVREFL_PT_mirror, context())
    assert "ior" in glass.shown and "tint" not in glass.shown


def test_a_long_list_of_mirrors_says_how_many_more() -> None:
    assert "and 3 more" in draw(panel.CURVREFL_PT_main, _many_hidden()).texts


def test_remarks_are_shown_once_with_the_material_and_a_button(monkeypatch: pytest.MonkeyPatch) -> None:
    causes = {"Rust": ["Wireframe nodes {of} are not drawn."], "Fog": ["Volumes {of} are not shown."]}
    told = ['Wireframe nodes of material "Rust" are not drawn.', 'Volumes of material "Fog" are not shown.', "Another."]
    monkeypatch.setattr(viewport, "messages", lambda: told)
    monkeypatch.setattr(viewport, "material_remarks", lambda: causes)
    drawn = draw(panel.CURVREFL_PT_main, _mirror())
    text = " ".join(drawn.texts)
    assert "Rust: Wireframe nodes are not drawn." in text and "Fog: Volumes are not shown." in text
    assert "Another." in text and "of material" not in text
    assert drawn.shown.count("curvrefl.bake_look") == 1


def test_sub_panels_are_closed_by_default() -> None:
    for cls in panel.CLASSES[1:]:
        assert cls.bl_parent_id == "CURVREFL_PT_main" and "DEFAULT_CLOSED" in cls.bl_options


def test_panels_of_the_render_engine() -> None:
    for cls in render_panels.CLASSES:
        assert draw(cls, context(engine="CYCLES")) is None
    of_eevee = draw(render_panels.CURVREFL_RENDER_PT_film, context(engine="BLENDER_EEVEE"))
    assert of_eevee is None, "nothing is to be filmed"
    _mirror()
    of_eevee = draw(render_panels.CURVREFL_RENDER_PT_film, context(engine="BLENDER_EEVEE"))
    assert {"render_samples", "curvrefl.set_up_film"} <= set(of_eevee.shown)
    assert "curvrefl.remove_film" not in of_eevee.shown
    of_engine = (render_panels.CURVREFL_RENDER_PT_quality, render_panels.CURVREFL_VIEW_LAYER_PT_passes)
    quality, passes = (draw(cls, context(engine="CURVREFL")) for cls in of_engine)
    assert "render_samples" in quality.shown and "samples" not in quality.shown
    assert {"use_pass_mirror", "use_pass_position", "use_pass_object"} <= set(passes.shown)
    bpy.context.scene.render.engine = "CURVREFL"
    camera = bpy.types.DATA_PT_camera
    assert "CURVREFL" in camera.COMPAT_ENGINES and "CURVREFL" in bpy.types.EEVEE_MATERIAL_PT_surface.COMPAT_ENGINES
    engine_panels.remove("CURVREFL")
    try:
        assert not [panel for panel in bpy.types.Panel.__subclasses__() if _is_for_engine(panel)]
    finally:
        engine_panels.add("CURVREFL")


def _is_for_engine(cls: Any) -> bool:
    return "CURVREFL" in getattr(cls, "COMPAT_ENGINES", ())


def test_a_message_is_wrapped_and_loses_no_word() -> None:
    sentence = "The mirror is open: close it, or choose another object that is seen whole from a point inside."
    lines = messages.wrapped(sentence, 30)
    assert " ".join(lines) == sentence
    assert all(len(line) <= 30 for line in lines) and len(lines) > 2
    assert messages.wrapped("short incomprehensibilities", 10) == ["short", "incomprehensibilities"]


def test_the_menus_are_as_before_once_unregistered() -> None:
    for name, entry in ENTRIES.items():
        assert entry in getattr(bpy.types, name).draw._draw_funcs
    menus.remove()
    try:
        for name, entry in ENTRIES.items():
            assert entry not in getattr(bpy.types, name).draw._draw_funcs
    finally:
        menus.add()
