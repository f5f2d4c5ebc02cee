# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The scene that `./curvrefl demo` shows, built from nothing."""
