# Installs the build into a scratch prefix, builds a consumer against it with find_package and runs that; every
# installed header must compile on its own.
#   bash install.sh BUILD_DIR COMPILER
set -euo pipefail
build=$1 compiler=$2
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() {
    echo "FAIL: $*" >&2
    exit 1
}

cmake --install "$build" --prefix "$scratch/prefix" >"$scratch/log" || fail "$(tail "$scratch/log")"
cp -r "$here/consumer" "$scratch/consumer"
mkdir "$scratch/consumer/headers"
cd "$scratch/prefix/include/sparselens"
find . -name '*.h' | while read -r header; do
    header=${header#./}
    echo "#include <sparselens/$header>" >"$scratch/consumer/headers/${header//\//_}.cpp"
done
[ -n "$(ls "$scratch/consumer/headers")" ] || fail "no headers were installed"

cmake -S "$scratch/consumer" -B "$scratch/build" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$scratch/prefix" >"$scratch/log" 2>&1 ||
    fail "find_package(sparselens): $(cat "$scratch/log")"
cmake --build "$scratch/build" -j 2 >"$scratch/log" 2>&1 ||
    fail "the consumer does not build: $(cat "$scratch/log")"
answer=$("$scratch/build/consumer")
[ "$answer" = 3.84 ] || fail "the consumer says '$answer' instead of 3.84"

for tool in "$build"/bin/ldi-* "$build"/bin/dof-*; do
    [ -e "$tool" ] || continue # the pattern itself, where nothing matches
    [ -x "$scratch/prefix/bin/${tool##*/}" ] || fail "${tool##*/} is not installed"
done
