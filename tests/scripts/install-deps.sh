# tools/install-deps.sh with stand-ins for dpkg-query, apt-get and id, so that nothing is installed here.
set -euo pipefail
script=$(cd "$(dirname "$0")/../.." && pwd)/tools/install-deps.sh
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

fail() {
    echo "FAIL: $*; output: $(cat output)" >&2
    exit 1
}

# stand_in NAME SHELL_CODE; the machine has only these and what the script may expect of a base system.
stand_in() {
    printf '#!/bin/sh\n%s\n' "$2" >"bin/$1"
    chmod +x "bin/$1"
}
mkdir bin
for base in cat env grep mktemp rm sed sh sort tail; do ln -s "$(command -v $base)" bin/$base; done
run() { PATH=$scratch/bin "$script" "$@" >output 2>&1; }
one_line() { [ "$(wc -l <output)" -eq 1 ]; }
installed='g++ ninja-build pkg-config libboost-dev libcli11-dev libembree-dev libfmt-dev libimath-dev libjpeg-dev
           libopencolorio-dev libopenexr-dev libopenimageio-dev libpng-dev libtbb-dev nlohmann-json3-dev openimageio-tools'
stand_in id 'echo 0'
stand_in apt-get 'echo "$@" >>calls; case "$*" in *" update"*) exit ${UPDATE_EXIT-0} ;; esac
if [ ${INSTALL_EXIT-0} -ne 0 ]; then echo "E: Unable to locate package cmake" >&2; exit $INSTALL_EXIT; fi'
query="for p in $(echo $installed)"'; do echo "$p installed"; done; echo "cmake config-files"; exit 1'
stand_in dpkg-query "$query"

run build || fail "the install failed"
grep -q ' install --no-install-recommends cmake$' calls || fail "not just cmake was asked for: $(cat calls)"
grep -q ' update$' calls || fail "no apt-get update"
[ "$(wc -l <calls)" -eq 2 ] || fail "apt-get was called $(wc -l <calls) times"
one_line || fail "not one line"

UPDATE_EXIT=100 run build || fail "a failed update of the lists stopped an install that works"
INSTALL_EXIT=100 run build && fail "a failed install passed"
grep -q 'could not install cmake: E: Unable to locate' output || fail "the cause is not named"
run build nonsense && fail "an unknown set passed"
one_line || fail "not one line"

rm calls
stand_in dpkg-query "echo 'cmake installed'; $query"
run build || fail "complains with all there"
one_line || fail "not one line"
[ ! -e calls ] || fail "apt-get was called with nothing missing"

stand_in dpkg-query "$query"
stand_in id 'echo 1000'
run build && fail "no sudo, yet it passed"
{ one_line && grep -q 'neither root nor sudo.*cmake' output; } || fail "no clear line without sudo"
stand_in sudo 'echo sudo >>calls; exec "$@"'
run build || fail "failed with sudo"
[ "$(grep -c '^sudo$' calls)" -eq 2 ] || fail "sudo was not used"

# Differences between Debian releases; an unknown release is treated like the newest.
asks_for() { # CODENAME SET
    echo "VERSION_CODENAME=$1" >os-release
    rm -f calls
    SPARSELENS_OS_RELEASE=$scratch/os-release run "$2" && tr ' ' '\n' <calls >asked
}
asks_for bookworm test && grep -qx clang-format-14 asked || fail "no clang-format-14 in Debian 12"
grep -q scikit asked && fail "scikit-build-core is not in Debian 12"
asks_for trixie test && grep -qx help2man asked || fail "no help2man in Debian 13"
grep -qx python3-scikit-build-core asked || fail "no scikit-build-core in Debian 13"
grep -q clang asked && fail "clang-format-14 is not in Debian 13"
asks_for trixie lint && fail "the set lint passed in Debian 13"
{ one_line && grep -q 'in Debian 12 alone' output; } || fail "no clear line on lint in Debian 13"
asks_for trixie blender && ! grep -q cattr asked || fail "Blender 4.3 needs no cattrs"
asks_for forky blender && grep -qx python3-cattr asked || fail "Blender 5 needs cattrs"

rm bin/apt-get
run build && fail "no apt-get, yet it passed"
{ one_line && grep -q 'apt-get is not there.*cmake' output; } || fail "no clear line without apt-get"
rm bin/dpkg-query
run build || fail "stops on another system"
{ one_line && grep -q 'not a Debian system' output; } || fail "no clear line on another system"
