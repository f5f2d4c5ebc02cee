# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One scene as the viewports show it: read when it changes, one renderer for each light that a viewport asks for."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import bpy

from ..errors import InputError
from ..optics.catalog import METHODS
from ..options import marked_mirrors, mirrors_in, newer_settings, overrides_of
from ..renderer.geometry.placed_instances import estimated_bytes
from ..renderer.renderer import Renderer
from ..renderer.settings import Settings
from ..scene.arrays import SceneArrays
from ..scene.camera.view import View
from ..scene.changes import Changes
from ..scene.extract import SceneReader
from ..scene.remarks import Remark
from .light import LightReader, ViewportLight, light_of
from .opening import FORGOTTEN_SECONDS, Opening
from .sketch import Sketch

MOST_RENDERERS = 3
"""Ways of lighting, and local views, of one scene whose pictures are kept"""


@dataclass(frozen=True, slots=True)
class Look:
    """What makes viewports on one scene show different pictures."""

    light: ViewportLight
    local_view: int = 0
    """Address of the viewport whose local view it is, 0: none"""


class ViewportScene:
    """A scene in one view layer."""

    def __init__(self) -> None:
        self.changes = Changes(everything=True)
        self.messages: list[str] = []
        """What the user should know, one sentence each"""
        self.renderers: dict[Look, Renderer] = {}
        """The one used last comes last"""
        self._reader = SceneReader()
        self._lights = LightReader()
        self._frame: int | None = None
        self._arrays: SceneArrays | None = None
        self._refused: dict[int, str] = {}
        """Objects (session_uid) that cannot be mirrors as they are, and why"""
        self._mirrors: list[bpy.types.Object] | None = None
        self._shown: dict[Look, SceneArrays] = {}
        self._dropped: Counter[str] = Counter()
        """Counts of renderers that are gone"""
        self._openings: dict[Look, Opening] = {}
        """Renderers on their way"""
        self.sketch: Sketch | None = None
        """What is shown until they are there"""

    @property
    def material_remarks(self) -> tuple[Remark, ...]:
        """What is not drawn of materials."""
        return self._reader.material_remarks if self._arrays is not None else ()

    @property
    def counters(self) -> dict[str, int]:
        """How often what was read from the scene and made for it."""
        total = Counter(self._reader.reads) + self._dropped
        for renderer in self.renderers.values():
            total.update(_made(renderer))
        return dict(total)

    def mirrors_changed(self) -> None:
        """Objects were marked, or their overrides changed: data-blocks are looked up anew."""
        self._mirrors = None
        self._refused.clear()
        self.changes.listing = True

    def note(self, updates: Any, frame: int) -> None:
        """Remember what a depsgraph updated, which is at this frame."""
        self.changes.add(updates)
        if frame != self._frame:
            # (Images that show another file are not among the updates.)
            self._frame = frame
            self.changes.images |= self._reader.sequences
        if self.changes.listing:
            self._mirrors = None

    def renderer(
        self, context: bpy.types.Context, look: Look, settings: Settings, memory_cap: int, image_memory: int
    ) -> Renderer | None:
        """The renderer for a viewport, brought up to date; None where there is nothing to show.

        `memory_cap`: bytes of GPU memory that meshes may take; `image_memory`: those that images of materials may.
        """
        return self._renderer(context, look, settings, memory_cap, image_memory, None)

    def renderer_soon(
        self,
        context: bpy.types.Context,
        look: Look,
        settings: Settings,
        memory_cap: int,
        image_memory: int,
        view: View,
        seconds: float,
    ) -> Renderer | None:
        """The same; where there is none yet it is worked on for about `seconds`, and None until pictures of the view
        can be drawn: then there is a `sketch`, and `progress` to be told."""
        return self._renderer(context, look, settings, memory_cap, image_memory, (view, seconds))

    @property
    def progress(self) -> str:
        """What renderers on their way wait for, for a panel; nothing where none is."""
        if self._arrays is not None and self._reader.unread:
            return f"{self._reader.unread} objects to read"
        begun = "" if self.sketch is None else "meshes"
        return next((opening.progress for opening in self._openings.values()), begun)

    def _renderer(
        self,
        context: bpy.types.Context,
        look: Look,
        settings: Settings,
        memory_cap: int,
        image_memory: int,
        soon: tuple[View, float] | None,
    ) -> Renderer | None:
        # (A scene that is shown already is not seen without a part of it.)
        seconds = None if soon is None or self.renderers else soon[1]
        begun = perf_counter()
        for other, opening in list(self._openings.items()):
            if other != look and begun - opening.asked_at > FORGOTTEN_SECONDS:
                self._drop(other)
        has_read = bool(self.changes) or self._mirrors is None or (self._arrays is not None and self._reader.unread > 0)
        if has_read:
            self._read(context, memory_cap, seconds)
        if self._arrays is None:
            self._leave_sketch()
            return None
        try:
            if soon is None or look in self.renderers:
                return self._up_to_date(context, look, settings, image_memory)
            view, seconds = soon
            left = seconds - (perf_counter() - begun)
            if self._reader.unread or (left <= 0.0 and has_read):
                self._draw_sketch(context)
                return None
            return self._opened(context, look, settings, image_memory, view, left)
        except InputError as error:
            self._drop(look)
            uid = self._culprit(error)
            if uid is None:
                self.messages.append(str(error))
                self._arrays = None
                return None
            self._refused[uid] = str(error)
            self.changes.listing = True
            self._mirrors = None
            return self._renderer(context, look, settings, memory_cap, image_memory, soon)

    def free(self) -> None:
        """Let go of everything."""
        for look in [*self.renderers, *self._openings]:
            self._drop(look)
        self._leave_sketch()

    def _opened(
        self,
        context: bpy.types.Context,
        look: Look,
        settings: Settings,
        image_memory: int,
        view: View,
        seconds: float,
    ) -> Renderer | None:
        """Go on with the renderer for a look; None while it cannot draw."""
        arrays = self._arrays_for(context, look)
        opening = self._openings.get(look)
        if opening is None:
            opening = self._openings[look] = Opening(arrays, settings, image_memory)
        is_same = opening.scene is arrays and opening.settings == settings
        if is_same and not opening.advance(view, seconds):
            self._draw_sketch(context)
            return None
        # (What changes meanwhile ends the waiting: it may change in every redraw.)
        self.renderers[look] = opening.finish()
        del self._openings[look]
        self._dropped["renderers made"] += 1
        if not self._openings:
            self._leave_sketch()
        return self._up_to_date(context, look, settings, image_memory)

    def _draw_sketch(self, context: bpy.types.Context) -> None:
        assert self._arrays is not None and context.scene is not None
        if self.sketch is None:
            world = context.scene.world
            red, green, blue = (0.05, 0.05, 0.05) if world is None else world.color
            self.sketch = Sketch(self._arrays, (red, green, blue))
        self.sketch.follow(self._arrays)

    def _leave_sketch(self) -> None:
        if self.sketch is not None:
            self.sketch.free()
            self.sketch = None

    def _read(self, context: bpy.types.Context, memory_cap: int, seconds: float | None) -> None:
        scene = context.scene
        assert scene is not None
        if self._mirrors is None:
            self._mirrors = marked_mirrors(scene)
        for uid in self.changes.geometry | self.changes.objects:
            self._refused.pop(uid, None)
        seen = [mirror for mirror in self._mirrors if mirror.visible_get(view_layer=context.view_layer)]
        if len(seen) < len(self._mirrors):
            # The others may be instanced, and seen for all that.
            seen = mirrors_in(context.evaluated_depsgraph_get())
        arrays = self._arrays_of(context, scene, seen, seconds)
        newer = newer_settings(scene)
        self.messages = [*([newer] if newer else []), *self._refused.values()]
        self._shown.clear()
        self._arrays = arrays
        if arrays is None:
            self.free()
            return
        method = METHODS.get(scene.curvrefl.method)
        needed = estimated_bytes(arrays, method is None or method.follows_rays or method.chooses)
        if needed > memory_cap:
            self._arrays = None
            self.messages.append(
                f"The scene needs about {needed >> 20} MB of GPU memory and the preferences allow "
                f"{memory_cap >> 20} MB: hide objects, or raise the memory limit."
            )

    def _arrays_of(
        self,
        context: bpy.types.Context,
        scene: bpy.types.Scene,
        seen: list[bpy.types.Object],
        seconds: float | None,
    ) -> SceneArrays | None:
        """The scene with those of the mirrors that can be ones. Changes stay until there is something to show."""
        while usable := [mirror for mirror in seen if mirror.session_uid not in self._refused]:
            self._lights.forget_images(self.changes.images)
            changes, self.changes = self.changes, Changes()
            try:
                return self._reader.read(
                    context.evaluated_depsgraph_get(), scene, usable, changes, overrides_of(usable), seconds
                )
            except InputError as error:
                uid = self._culprit(error)
                if uid is None:
                    raise
                self._refused[uid] = str(error)
        return None

    def _up_to_date(self, context: bpy.types.Context, look: Look, settings: Settings, image_memory: int) -> Renderer:
        arrays = self._arrays_for(context, look)
        renderer = self.renderers.pop(look, None)
        if renderer is None:
            renderer = Renderer(arrays, settings, image_memory, is_gradual=True)
            self._dropped["renderers made"] += 1
        while len(self.renderers) >= MOST_RENDERERS:
            self._drop(next(iter(self.renderers)))
        self.renderers[look] = renderer
        renderer.update(arrays)
        if renderer.settings != settings:
            renderer.configure(settings)
        return renderer

    def _arrays_for(self, context: bpy.types.Context, look: Look) -> SceneArrays:
        """The scene in a look's light, or what a local view leaves of it."""
        if look not in self._shown:
            assert self._arrays is not None
            self._shown[look] = self._lights.lit(self._local(context, look), look.light)
        return self._shown[look]

    def _local(self, context: bpy.types.Context, look: Look) -> SceneArrays:
        """What a local view leaves of the scene."""
        assert self._arrays is not None
        if not look.local_view:
            return self._arrays
        space = context.space_data
        assert isinstance(space, bpy.types.SpaceView3D)
        shown = {obj.session_uid for obj in bpy.data.objects if obj.local_view_get(space)}
        return self._reader.only(self._arrays, shown)

    def _culprit(self, error: InputError) -> int | None:
        """The mirror (session_uid) that an error is about; None where it is none that could be left out."""
        uid = self._reader.uid_of(error.object_id)
        marked = {mirror.session_uid for mirror in self._mirrors or ()}
        return uid if uid in marked - self._refused.keys() else None

    def _drop(self, look: Look) -> None:
        renderer = self.renderers.pop(look, None)
        self._shown.pop(look, None)
        if renderer is not None:
            self._dropped.update(_made(renderer))
            renderer.free()
        opening = self._openings.pop(look, None)
        if opening is not None:
            opening.free()
        self._lights.keep({kept.light for kept in (*self.renderers, *self._openings)})


def _made(renderer: Renderer) -> dict[str, int]:
    return {**renderer.counters, **renderer.geometry.counters, **renderer.hierarchies.counters}


def look_of(space: bpy.types.SpaceView3D, settings: Any) -> Look:
    """How a viewport shows its scene."""
    return Look(light_of(space, settings), space.as_pointer() if space.local_view is not None else 0)
