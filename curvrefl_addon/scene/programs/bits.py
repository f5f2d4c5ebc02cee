# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flags that programs and shaders share."""

KIND_GLOSSY_ONLY = 1
"""Of the channel `kind`: reflects the base color at all angles"""
KIND_THIN_WALL = 2
KIND_GLASS = 4
"""Glass in place of Principled"""
KIND_REFRACTION = 8
RAY_IS_CAMERA = 1
"""Of `ShadingPoint.ray`"""
RAY_IS_REFLECTION = 2
RAY_IS_TRANSMISSION = 4
RAY_IS_DIFFUSE = 8
RAY_IS_GLOSSY = 16
RAY_IS_SINGULAR = 32
RAY_IS_SHADOW = 64
