# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user can put right."""

from __future__ import annotations


class InputError(Exception):
    """A user's mistake. The message is one sentence that says what to do; the command line exits with 2."""
