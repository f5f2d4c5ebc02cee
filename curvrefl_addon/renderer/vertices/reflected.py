# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
from ..surfaces.surfaces import draw_reflected as draw_reflected
