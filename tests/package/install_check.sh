#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# install_check.sh SUITE...: installs the Debian packages of out/ in a clean chroot of each suite and runs them. In a
# suite with other versions of the libraries they cannot be installed; the chroot builds its own from the committed
# sources, which takes as long as a build. Needs root, mmdebstrap, and an apt source of Debian on this machine, whose
# mirror serves all suites.
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

# inside COMMAND: in the chroot, with its own /proc, where services do not start and the locale is C.
inside() {
  unshare --mount sh -euc 'mount -t proc proc "$0/proc"; exec chroot "$0" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin \
    HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive sh -euc "$1"' "$root" "$1"
}
# silently COMMAND...: its output goes to the log, of which the end is shown if the command fails.
silently() { "$@" >>"$log" 2>&1 || { tail -n 40 "$log" >&2; say "failed; all output is in $log"; exit 1; }; }

# minimal_system FOLDER PACKAGES: a new chroot with these packages in /packages.
minimal_system() {
  root=$1
  silently mmdebstrap --mode=root --variant=apt "$suite" "$root" "$mirror"
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  silently inside 'apt-get -q update'
  mkdir "$root/packages"
  cp "$2"/*.deb "$root/packages"
}

install='apt-get -q install -y --no-install-recommends /packages/earthshine_*.deb /packages/python3-earthshine_*.deb'
for suite in "$@"; do
  log=$top/out/check-$suite.log
  : >"$log"
  say "$suite: a minimal system"
  minimal_system "$folder/$suite" out
  if ! inside "$install --simulate" >"$folder/refused" 2>&1; then
    cat "$folder/refused" >>"$log"
    if [[ $suite == "$own" ]]; then
      cat "$folder/refused" >&2
      say "$suite: packages that were built here cannot be installed"
      exit 1
    fi
    say "$suite: other libraries than in $own: $(grep -m 1 -o 'Depends: .*' "$folder/refused")"
    say "$suite: so packages are built from the committed sources, into out/$suite"
    mkdir "$root/source"
    git -C "$top" archive HEAD | tar -x -C "$root/source"
    silently inside 'apt-get -q install -y --no-install-recommends bash git; cd /source; git init -q; ./dev package'
    if grep -q 'will write reports without' "$log"; then
      say "$suite: npm fetched nothing in the chroot, so these packages write plain reports"
    fi
    mkdir -p "out/$suite"
    cp "$root"/source/out/*.deb "out/$suite"
    rm -rf --one-file-system "$root"
    minimal_system "$folder/$suite-clean" "out/$suite"
  fi
  say "$suite: apt install, without recommended packages"
  silently inside "$install"
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
  '
  silently inside 'apt-get -q purge -y earthshine python3-earthshine; ! command -v earthshine'
  say "$suite: installed, run and removed"
done
