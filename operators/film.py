# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Set up a film: EEVEE's pictures with true mirrors in them, by Blender's own renders; and take it away again."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from pathlib import PurePath
from typing import Any, Literal

import bpy
from bpy.props import BoolProperty

from ..curvrefl_addon.errors import InputError


class CURVREFL_OT_set_up_film(bpy.types.Operator):
    """Put the true mirrors into what EEVEE renders of this scene: stills, animations and video.

    Adds a scene for the mirrors, a view layer in which they are held out, and nodes that join them"""

    bl_idname = "curvrefl.set_up_film"
    bl_label = "Set Up Film"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender's own convention)

    layers: BoolProperty(  # type: ignore[valid-type]
        name="Layers to Files",
        description="Also write a multilayer EXR a frame: film, EEVEE, held out, and the mirrors with what they show",
        default=False,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene is not None

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        from ..curvrefl_addon.film.film import set_up
        from ..curvrefl_addon.film.follow import look_for_films
        from ..curvrefl_addon.film.wiring import add_layers_file

        scene: Any = context.scene
        try:
            told = set_up(scene)
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            look_for_films()
        if self.layers:
            beside = PurePath(scene.render.filepath)
            add_layers_file(scene, str(beside.parent), f"{beside.name}layers_")
        for sentence in told:
            self.report({"WARNING"}, sentence)
        self.report({"INFO"}, "The film is set up: renders of this scene have true mirrors")
        return {"FINISHED"}


class CURVREFL_OT_remove_film(bpy.types.Operator):
    """Take the film's scene, view layer and nodes away: the file is as it was before"""

    bl_idname = "curvrefl.remove_film"
    bl_label = "Remove Film"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender's own convention)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        from ..curvrefl_addon.film.film import film_of

        if context.scene is None or film_of(context.scene) is None:
            cls.poll_message_set("The scene has no film")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[Literal["FINISHED"]]:  # type: ignore[override]
        from ..curvrefl_addon.film.film import remove
        from ..curvrefl_addon.film.follow import look_for_films

        assert context.scene is not None
        remove(context.scene)
        look_for_films()
        return {"FINISHED"}


CLASSES = (CURVREFL_OT_set_up_film, CURVREFL_OT_remove_film)
