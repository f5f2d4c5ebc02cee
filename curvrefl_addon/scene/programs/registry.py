# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All nodes that programs know, by their type: the tables of the files in `nodes`."""

from __future__ import annotations

from collections.abc import Mapping

from .builder import Handler
from .nodes import images

HANDLERS: Mapping[str, Handler] = {**images.NODES}
