#!/bin/bash
# Compiles the libraries of src, tools and lab for link-time optimisation and links all of them once: the linker then
# sees types, functions or variables with one name that differ between files. Any such difference is an error. No code
# is made of it, and nothing is run.
#
#   tests/lto.sh
#
# Builds in build-lto/, with GCC.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

libraries=(src/libsparselens.a tools/libsparselens_tools.a tools/libsparselens_viewing.a lab/libsparselens_lab.a
    lab/libsparselens_lab_tools.a lab/libsparselens_references.a)
linked() { g++ -flto=auto -r -flinker-output=rel -nostdlib -Wodr -Wlto-type-mismatch -Werror -Wl,--whole-archive "$@"; }

cmake --preset lto --log-level=WARNING -DSPARSELENS_TESTS=OFF -DSPARSELENS_BENCHMARKS=OFF
cmake --build build-lto -j "$(nproc)" --target "${libraries[@]}"
cd build-lto
linked -o lto.o "${libraries[@]}"
# The linker sees a difference if there is one.
printf 'struct S { int a; };\nvoid f(S);\nvoid g(S s) { f(s); }\n' >one.cpp
printf 'struct S { long a; };\nvoid f(S s) { (void)s; }\n' >two.cpp
for name in one two; do g++ -flto -c $name.cpp -o $name.o; done
if linked -o differ.o one.o two.o 2>differ.log || ! grep -q 'One Definition Rule' differ.log; then
    echo "FAIL: lto.sh does not see that two files declare differently: $(cat differ.log)" >&2
    exit 1
fi
