#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# install_check.sh SUITE...: installs the Debian packages in a clean chroot of each suite and runs them. Packages are
# installed where they were built: in this machine's own suite from out/. For another suite the chroot builds them first
# from the committed sources, which takes as long as a build. Needs root, mmdebstrap, and apt sources of Debian on this
# machine, whose mirror serves all suites.
set -euo pipefail
cd "$(dirname "$0")/../.."
top=$PWD
say() { printf 'install check: %s\n' "$*" >&2; }

own=$(. /etc/os-release && echo "$VERSION_CODENAME")
mirror=$(apt-get indextargets --format '$(LABEL) $(CODENAME) $(SITE)' 'Created-By: Packages' |
  awk -v own="$own" '$1 == "Debian" && $2 == own { print $3; exit }')
[[ $mirror ]] || { say "this machine has no apt source of Debian $own"; exit 1; }

folder=$(mktemp -d)
trap 'rm -rf --one-file-system "$folder"' EXIT

# inside COMMAND: in the chroot, where services do not start and the locale is C.
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive sh -euc "$1"; }

for suite in "$@"; do
  root=$folder/$suite
  say "$suite: a minimal system"
  mmdebstrap --mode=root --variant=apt --quiet "$suite" "$root" "$mirror"
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  mkdir "$root/packages"
  if [[ $suite == "$own" ]]; then
    cp out/*.deb "$root/packages"
  else
    say "$suite: packages from the committed sources"
    mkdir "$root/source"
    git -C "$top" archive HEAD | tar -x -C "$root/source"
    inside 'apt-get -qq install -y bash git >/dev/null; cd /source; git init -q; ./dev package >/dev/null; cp out/*.deb /packages'
  fi
  say "$suite: apt install, without recommended packages"
  rm -rf "${root:?}/source"
  inside 'apt-get -qq install -y --no-install-recommends /packages/earthshine_*.deb /packages/python3-earthshine_*.deb >/dev/null'
  say "$suite: the program, its scenes and its module"
  inside '
    earthshine --version
    cd /tmp
    scene=/usr/share/earthshine/scenes/sts46/night-lamps.toml
    earthshine render $scene --camera B --size 64x64 --error 0.3 -o b.exr --png b.png --cctv monitor.png -q
    earthshine view b.exr -q
    earthshine new mine.toml -q
    test -s b.exr; test -s b.png; test -s monitor.png; test -s b.html; test -s mine.toml
    test -s /usr/share/man/man1/earthshine.1.gz -o -s /usr/share/man/man1/earthshine.1
    test -s /usr/share/bash-completion/completions/earthshine
    python3 - $scene <<TEXT
import sys, earthshine
frame = earthshine.load(sys.argv[1]).render("B", error=0.3, size=(64, 64))
frame.save("python.exr")
assert frame.rgb.shape == (64, 64, 3) and frame.rgb.max() > 0
TEXT
    cmp b.exr python.exr
    apt-get -qq purge -y earthshine python3-earthshine >/dev/null
    ! command -v earthshine >/dev/null
  '
  say "$suite: installed, run and removed"
done
