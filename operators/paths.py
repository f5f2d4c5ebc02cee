# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Where operators write, from what the user has chosen or typed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy

from ..curvrefl_addon.errors import InputError


def output_path(text: str, what: str) -> Path:
    """The absolute path of a text that may start with // for the file's own folder; `what` for instance "a folder".

    Raises InputError for no text, and for // in a file that has none.
    """
    if not text:
        raise InputError(f"Choose {what}.")
    if text.startswith("//") and not bpy.data.filepath:
        raise InputError(f"Save the file first, or choose {what} that does not depend on it.")
    return Path(bpy.path.abspath(text))


class ChoosesFile:
    """Of an operator that asks for its `filepath` where it is called in a window."""

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> Any:
        operator: Any = self
        # What nobody has set the browser would not show, but the name of the open file.
        if path := operator.filepath:
            is_lost = path.startswith("//") and not bpy.data.filepath
            operator.filepath = str(Path.home() / path[2:]) if is_lost else bpy.path.abspath(path)
        context.window_manager.fileselect_add(operator)
        return {"RUNNING_MODAL"}
