#!/bin/bash
# Checks the sources with clang 14.
#
#   tests/clang.sh             build everything into build-clang/, warnings as errors
#   tests/clang.sh --rest      only read, with the same warnings, what was not built there
#   tests/clang.sh --tidy      clang-tidy over src and tools, findings as errors
#   tests/clang.sh --format    are all sources formatted as .clang-format asks? (77: clang-format-14 is missing)
#   tests/clang.sh --format-in-place
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

# need PROGRAM: it is version 14's, which is in Debian 12 alone.
need() {
    if ! command -v "$1" >/dev/null && ! grep -q '^VERSION_CODENAME=bookworm' /etc/os-release; then
        echo "skipped: $1, which is in Debian 12 alone"
        exit 77
    fi
    command -v "$1" >/dev/null || { echo "skipped: $1 is not installed"; exit 77; }
}

sources() { find src tools lab plugins tests '(' -name '*.cpp' -o -name '*.c' -o -name '*.h' ')' -print0 | sort -z; }

configure() {
    tools/install-deps.sh build test lint
    cmake --preset clang --log-level=WARNING
}

case ${1-} in
'')
    configure
    cmake --build build-clang -j "$(nproc)"
    ;;
--rest)
    configure
    python3 - <<'END'
import concurrent.futures, json, os, re, subprocess, sys
def read(rule):
    command = re.sub(r" -o \S+ -c ", " -fsyntax-only ", re.sub(r" -M[FT] \S+| -MD", "", rule["command"]))
    return subprocess.run(command, shell=True, cwd=rule["directory"]).returncode
def is_built(rule):
    return os.path.exists(os.path.join(rule["directory"], re.search(r" -o (\S+) ", rule["command"])[1]))
rest = [r for r in json.load(open("build-clang/compile_commands.json")) if not is_built(r)]
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    failed = sum(map(bool, pool.map(read, rest)))
print(f"clang.sh: {failed} of {len(rest)} files have warnings or errors")
sys.exit(failed > 0)
END
    ;;
--tidy)
    configure
    find src tools -name '*.cpp' -print0 | sort -z |
        xargs -0 -n 1 -P "$(nproc)" clang-tidy-14 -p build-clang --quiet --warnings-as-errors='*' 2>&1 |
        { grep -v 'warnings generated' || true; } # those of others' headers, which it hides
    ;;
--format)
    need clang-format-14
    sources | xargs -0 clang-format-14 --dry-run -Werror
    ;;
--format-in-place)
    need clang-format-14
    sources | xargs -0 clang-format-14 -i
    ;;
*)
    echo "clang.sh: unknown option $1 (--rest, --tidy, --format, --format-in-place)" >&2
    exit 2
    ;;
esac
