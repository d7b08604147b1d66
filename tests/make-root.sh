#!/bin/bash
# Makes a root of another release of Debian by debootstrap, if it is not there yet.
#
#   tests/make-root.sh SUITE FOLDER
#
# Needs root, debootstrap, and apt's lists (apt-get update). Uses this machine's apt settings: the mirror, a proxy, and
# whether old lists are acceptable. The output of debootstrap is in FOLDER-root.log.
set -euo pipefail
suite=$1 root=$2
fail() {
    echo "make-root.sh: $*" >&2
    exit 1
}
[ ! -e "$root/etc/debian_version" ] || exit 0
command -v debootstrap >/dev/null || fail "debootstrap is not installed"
proxy=
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Label: Debian' 'Created-By: Packages' | sort -u | head -n 1)
[ -n "$mirror" ] || fail "apt knows no mirror of Debian: apt-get update"
eval "$(apt-config shell proxy Acquire::http::Proxy)"
mkdir -p "${root%/*}"
http_proxy=${proxy:-${http_proxy-}} debootstrap --variant=minbase "$suite" "$root.new" "$mirror" >"$root-root.log" 2>&1 ||
    fail "debootstrap: $(tail -n 1 "$root-root.log")"
apt-config dump | grep -E '^Acquire::(http::Proxy|Check-Valid-Until|Check-Date) ' >"$root.new/etc/apt/apt.conf.d/99host" || true
mv "$root.new" "$root"
