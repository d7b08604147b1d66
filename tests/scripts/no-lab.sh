#!/bin/bash
# Without Embree the project configures, the laboratory is off by default, the library builds, and no command that
# builds or links the rest names Embree, the laboratory or a header of either. If the laboratory is asked for, the error
# says what to do.
#
#   tests/scripts/no-lab.sh BUILD_DIR     the commands of the library are those of BUILD_DIR, so that is not built again
#   tests/scripts/no-lab.sh all           builds the tools and the tests too, and runs the unit tests
#
# With `all` everything is built without optimisation, which takes several minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
exec </dev/null

build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
built='' same=(-DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0)
if [ "${1:?usage: no-lab.sh BUILD_DIR, or all}" != all ]; then
    built=$(cd "$1" && pwd)
    # The settings that determine the commands of the library.
    values='CMAKE_(BUILD_TYPE|INSTALL_PREFIX|CXX_(COMPILER|COMPILER_LAUNCHER|FLAGS(_[A-Z]+)?))'
    values+='|SPARSELENS_(WERROR|SANITIZE|PYTHON|GPU)|BUILD_SHARED_LIBS'
    mapfile -t same < <(sed -nE "s/^(($values):[^=]*=.*)\$/-D\1/p" "$built/CMakeCache.txt")
fi
configure() {
    cmake -S . -B "$build" -G Ninja -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON -DSPARSELENS_BENCHMARKS=OFF \
        "${same[@]}" "$@" >"$build/said" 2>&1
}
# The commands that build the library, for any folder.
library_commands() { ninja -C "$1" -t commands sparselens | sed "s#$1#BUILD#g" | sort; }

if configure -DSPARSELENS_LAB=ON; then
    echo "the laboratory is configured without Embree"
    exit 1
fi
grep -q 'SPARSELENS_LAB=OFF' "$build/said" || { cat "$build/said"; exit 1; }

rm "$build/CMakeCache.txt"
configure || { cat "$build/said"; exit 1; }
grep -q '^SPARSELENS_LAB:BOOL=OFF$' "$build/CMakeCache.txt" || { echo "the laboratory is on without Embree"; exit 1; }
ninja -C "$build" -t commands >"$build/commands"
grep -q 'dof-gather' "$build/commands" || { echo "no dof-gather is built"; exit 1; }
if grep -iE 'embree|sparselens_lab|[ /]lab/' "$build/commands"; then
    echo "these commands need the laboratory"
    exit 1
fi
if grep -rnE '#include [<"](embree|lab/)' src tools tests --include='*.h' --include='*.cpp'; then
    echo "these files need the laboratory"
    exit 1
fi

if [ -n "$built" ]; then
    diff <(library_commands "$built") <(library_commands "$build") || { echo "with the laboratory (<) the library is another"; exit 1; }
    ninja -C "$built" sparselens >"$build/said" || { cat "$build/said"; exit 1; } # nothing to do if everything is built
    exit 0
fi
ninja -C "$build"
"$build/bin/sparselens-tests" --gtest_brief=1
