#!/bin/sh
# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# enter_root.sh ROOT FOLDER.. -- COMMAND..: run the command in another Linux root that sees these folders of ours.
# To be called in a mount namespace of its own (unshare --mount): what is mounted here ends with it, however it ends.
set -eu
root=$1
shift
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"
mount -t sysfs sysfs "$root/sys"
while [ "$1" != -- ]; do
    mkdir -p "$root$1"
    mount --bind "$1" "$root$1"
    shift
done
shift
# No exec: as the first process of a namespace xvfb-run would never hear that its screen is ready.
chroot "$root" /usr/bin/env PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"
