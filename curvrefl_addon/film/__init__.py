# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""EEVEE's pictures with true mirrors in them, joined by Blender's own pipeline: F12, animations, farms and video do it.

A scene that is filmed gets a scene beside it, which shows it as its background set and which the engine CURVREFL
renders; a view layer in which its mirrors are held out; and nodes in its compositor that join the three.
"""
