#!/bin/bash
# Runs all tests in another release of Debian, in a root of its own made by debootstrap, or the root of an earlier run.
#
#   tests/platforms.sh SUITE [STEP...]     SUITE: bookworm, trixie, sid; steps: demo, tests, wheel, blender (all)
#
# Tests the last commit: demo is README's first command, tools/demo.sh; tests is its second, tests/run.sh; wheel is
# tests/packaging/wheel.sh with pip's result; blender is tests/blender with Debian's Blender. Prints a table at the end:
# versions, tests, skips; exits with 1 if something fails. Needs root, debootstrap, and apt's lists (apt-get update),
# whose Debian mirror it uses. Roots are in $SPARSELENS_ROOTS (/var/tmp/sparselens-roots), 3 GB each; the output of the
# steps is in SUITE-STEP.log there. The builds use $CCACHE_DIR too, if set.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null
source=$PWD

fail() {
    echo "platforms.sh: $*" >&2
    exit 1
}
case ${1-} in bookworm | trixie | sid) suite=$1 ;; *) fail "name a suite: bookworm, trixie or sid" ;; esac
shift
steps=("$@")
[ $# -gt 0 ] || steps=(demo tests wheel blender)
for step in "${steps[@]}"; do [[ $step =~ ^(demo|tests|wheel|blender)$ ]] || fail "no step $step (demo, tests, wheel, blender)"; done
[ "$(id -u)" -eq 0 ] || fail "only root may make a root of another release and mount in it"
roots=${SPARSELENS_ROOTS:-/var/tmp/sparselens-roots}
root=$roots/$suite

# Mounts are private, so that they cannot reach the machine's own /dev, and unmounting them does not affect it.
mounted=()
mount_at() { # FOLDER ARGUMENT...
    mkdir -p "$root$1"
    mountpoint -q "$root$1" && return
    mount "${@:2}" "$root$1"
    mounted+=("$root$1")
}
unmount() {
    local i
    for ((i = ${#mounted[@]} - 1; i >= 0; --i)); do umount -R "${mounted[i]}"; done
}
within() {
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 ${CCACHE_DIR:+CCACHE_DIR=/var/cache/ccache} \
        ${CCACHE_DIR:+CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_SLOPPINESS=pch_defines,time_macros} chroot "$root" bash -euc "cd /root/sparselens && $1"
}

tests/make-root.sh "$suite" "$root"
trap unmount EXIT
mount_at /proc -t proc proc
mount_at /sys -t sysfs sysfs
[ ! -d /sys/fs/cgroup ] || mount_at /sys/fs/cgroup --rbind --make-rprivate /sys/fs/cgroup # with its controllers, for Slurm 22
mount_at /dev --bind --make-private /dev
mount_at /dev/pts --bind --make-private /dev/pts
mount_at /dev/shm -t tmpfs tmpfs
cp -L /etc/resolv.conf "$root/etc/" 2>/dev/null || true
within true 2>/dev/null || git clone -q "$source" "$root/root/sparselens"
git -C "$root/root/sparselens" fetch -q "$source" HEAD
git -C "$root/root/sparselens" checkout -q --detach FETCH_HEAD
# The first packages are needed to install others and to clone.
within 'export DEBIAN_FRONTEND=noninteractive; apt-get -q update && apt-get -q -y install --no-install-recommends ca-certificates git '"${CCACHE_DIR:+ccache}" \
    >"$root-packages.log" 2>&1 || fail "apt-get: $(grep -m 1 '^E:' "$root-packages.log")"
cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/" 2>/dev/null || true # of this machine's proxy, for PyPI
[ -z "${CCACHE_DIR-}" ] || mount_at /var/cache/ccache --bind "$CCACHE_DIR"
[ ! -d "$source/../shared" ] || mount_at /root/shared --bind "$source/../shared"

code=0
results=()
for step in "${steps[@]}"; do
    log=$root-$step.log
    case $step in
    demo)
        if within tools/demo.sh >"$log" 2>&1; then results+=('demo: passed'); else
            code=1
            results+=("demo: failed: $(tail -n 1 "$log")")
        fi
        ;;
    tests)
        within tests/run.sh >"$log" 2>&1 || code=1
        results+=("$(sed -nE 's/^.* tests passed, .* out of ([0-9]+)$/tests: \1/p' "$log")"
            "$(sed -nE 's/^([0-9]+)% tests passed, ([0-9]+) tests? failed .*/failed: \2/p' "$log")"
            "$(grep '^left out' "$log" || echo 'left out: nothing')")
        ;;
    wheel)
        within 'tests/packaging/wheel.sh build/bin' >"$log" 2>&1 || [ $? -eq 77 ] || code=1
        results+=("wheel: $(tail -n 1 "$log" | sed 's/^wheel: //')")
        ;;
    blender)
        if within 'tools/install-deps.sh build blender demo test && cmake --preset release --log-level=WARNING &&
                cmake --build build -j "$(nproc)" && bash tests/blender/run.sh build/bin' >"$log" 2>&1; then
            results+=("Blender: passed" "$(grep '^skipped' "$log" || echo 'Blender: skipped nothing')")
        else
            code=1
            results+=("Blender: failed: $(tail -n 1 "$log")")
        fi
        ;;
    esac
done

version() { within "dpkg-query -W -f='\${Version}' $1" 2>/dev/null || echo none; }
echo "| $suite | $(git -C "$root/root/sparselens" rev-parse --short HEAD), $(date +%Y-%m-%d) |"
echo "|---|---|"
for package in g++ cmake libopenexr-dev libopenimageio-dev libopencolorio-dev libembree-dev libtbb-dev libfmt-dev \
    pybind11-dev python3 python3-numpy libvulkan-dev blender; do
    echo "| $package | $(version $package) |"
done
printf '%s\n' "${results[@]}" | sed -E '/^$/d; s/^([^:]*): (.*)$/| \1 | \2 |/'
[ $code -eq 0 ] || echo "platforms.sh: something failed: see $root-*.log"
exit $code
