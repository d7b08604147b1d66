#!/bin/bash
# Makes the archive of the tools for 64-bit ARM on a Debian 12 of x86-64.
#
#   tools/arm.sh [FOLDER [ROOT]]     FOLDER: where the archive goes (release); ROOT: a Debian of arm64, which is made
#                                    where it is not there (2 GB; /var/tmp/sparselens-roots/arm64)
#
# Half an hour on two cores the first time, ten minutes with a ROOT. As root; needs the net. Debian's cross compiler makes
# the programs, with the libraries of ROOT; tools/bundle.sh runs in ROOT by qemu. tests/packaging/same-everywhere.sh
# compares what they make with what this machine's programs make.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
fail() {
    echo "arm.sh: $*" >&2
    exit 1
}
[ $# -le 2 ] || fail "usage: tools/arm.sh [FOLDER [ROOT]]"
[ "$(id -u)" -eq 0 ] || fail "it installs packages and changes its root: run it as root"
build=$here/build-arm64 out=${1:-$here/release} root=${2:-/var/tmp/sparselens-roots/arm64}
mkdir -p "$build" "$out" "$root"
out=$(cd "$out" && pwd) root=$(cd "$root" && pwd)
say() { echo "arm.sh: $* (after $SECONDS s)"; }

"$here/tools/install-deps.sh" arm gpu python
# The kernel starts programs of arm64 by qemu, also those in ROOT.
rules=/proc/sys/fs/binfmt_misc
[ -e $rules/register ] || mount -t binfmt_misc none $rules || fail "binfmt_misc cannot be mounted"
[ -e $rules/qemu-aarch64 ] || cat /usr/lib/binfmt.d/qemu-aarch64.conf >$rules/register

say "the Debian of arm64"
[ -s "$root/etc/os-release" ] || debootstrap --arch=arm64 --variant=minbase bookworm "$root" >"$build/root.log" ||
    fail "debootstrap: $(tail -n 1 "$build/root.log")"
inside() { # COMMAND...: in ROOT, which has the sources at their own path
    unshare --mount bash -c 'mkdir -p "$0$1" "$0$2" && mount --bind "$1" "$0$1" && mount --bind "$2" "$0$2" &&
        mount -t proc proc "$0/proc" && exec chroot "$0" env -C "$1" LC_ALL=C "${@:3}"' "$root" "$here" "$out" "$@"
}
inside tools/install-deps.sh build bundle gpu python

say "the build"
python=$(/usr/bin/python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
export QEMU_LD_PREFIX=$root # what the build runs finds the libraries of ROOT
cmake -S "$here" -B "$build" --preset release --toolchain "$here/cmake/Arm64.cmake" -DSPARSELENS_SYSROOT="$root" \
    -DSPARSELENS_{BENCHMARKS,TESTS}=OFF -DSPARSELENS_PYTHON=ON -DSPARSELENS_PYTHON_DIR:STRING=. -DPython_EXECUTABLE=/usr/bin/python3 \
    -DPython_INCLUDE_DIR="$root/usr/include/python$python" -DPYBIND11_PYTHON_EXECUTABLE_LAST=/usr/bin/python3 \
    -DPYTHON_MODULE_EXTENSION=".cpython-${python/./}-aarch64-linux-gnu.so" --log-level=WARNING
cmake --build "$build" -j "$(nproc)"

say "the archive"
inside tools/bundle.sh "$build" "$out"

say done
