# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Films follow their scenes while these are edited: in Blender's main thread, and only where a file has a film."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import bpy
from bpy.app.handlers import persistent

from .film import film_of, follow


def follow_films() -> None:
    """Make all films of the file like their scenes."""
    for film in list(bpy.data.scenes):
        source = film.curvrefl.film_source
        if source is not None and source != film:
            follow(source, film)


def look_for_films() -> None:
    """Begin to follow where the file has a film, and end where it has none."""
    handlers = bpy.app.handlers.depsgraph_update_post
    has_films = any(scene.curvrefl.film_source is not None for scene in bpy.data.scenes)
    if has_films and _changed not in handlers:
        handlers.append(_changed)
    elif not has_films and _changed in handlers:
        handlers.remove(_changed)


@persistent
def _changed(_scene: Any, depsgraph: Any) -> None:
    """Scenes list what is added to them, hidden in them or set in them; what is moved or shaped is none of it."""
    if threading.current_thread() is not threading.main_thread():
        return
    if depsgraph.id_type_updated("SCENE") or depsgraph.id_type_updated("COLLECTION"):
        follow_films()


@persistent
def _opened(*_arguments: Any) -> None:
    look_for_films()


@persistent
def _begins(scene: Any, *_arguments: Any) -> None:
    """In background nothing has followed a script's changes. (In a window renders run in a thread of their own.)"""
    if bpy.app.background and (film := film_of(scene)) is not None:
        follow(scene, film)


def _handlers() -> list[tuple[list[Any], Callable[..., None]]]:
    handlers = bpy.app.handlers
    opened = [(handlers.load_post, _opened), (handlers.undo_post, _opened), (handlers.redo_post, _opened)]
    return [*opened, (handlers.render_init, _begins)]


CLASSES = ()


def add() -> None:
    """Hear of opened files and of renders."""
    for handlers, function in _handlers():
        handlers.append(function)


def remove() -> None:
    """Leave nothing behind."""
    for handlers, function in (*_handlers(), (bpy.app.handlers.depsgraph_update_post, _changed)):
        if function in handlers:
            handlers.remove(function)
