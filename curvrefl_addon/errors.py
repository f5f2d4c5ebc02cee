# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user can put right."""

from __future__ import annotations


class InputError(Exception):
    """A user's mistake. The message is one sentence that says what to do; the command line exits with 2."""

    def __init__(self, message: str, object_id: int = 0) -> None:
        super().__init__(message)
        self.object_id = object_id
        """`InstanceArrays.object_id` of the object that has to be put right; 0 where it is none or not known which"""
