# Shared by the scripts that test executables; they begin with
#     . "$(dirname "$0")/check.sh"
# and are run as `bash SCRIPT BIN_DIR`. Sets $bin, and makes a scratch folder the current one, deleted at the end.
set -euo pipefail
bin=$(cd "${1:?usage: bash SCRIPT BIN_DIR}" && pwd)
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
export SPARSELENS_NO_HISTORY=1 # files from different commands are compared
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# Whether the laboratory is there. It has its own tools, and a method of dof-gather.
lab() { [ -x "$bin/dof-trace" ]; }
of_lab() { ! lab || echo "$@"; } # of_lab WORD...: these, if so

fail() {
    echo "FAIL: $*" >&2
    exit 1
}

skip() {
    echo "skipped: $*"
    exit 77
}

# exits CODE COMMAND...: the command ends with that code; its output is left in the files stdout and stderr.
exits() {
    local expected=$1 code=0
    shift
    "$@" >stdout 2>stderr </dev/null || code=$?
    [ "$code" -eq "$expected" ] || fail "exit $code instead of $expected: $* ($(head -c 500 stderr)$([ -s stderr ] || tail -c 1000 stdout))"
}

# fails_saying CODE PATTERN COMMAND...: it ends with that code and one line on stderr that matches (grep -E).
fails_saying() {
    local code=$1 pattern=$2
    shift 2
    exits "$code" "$@"
    [ "$(wc -l <stderr)" -eq 1 ] || fail "not one line: $* ($(head -c 500 stderr))"
    grep -Eq -e "$pattern" stderr || fail "'$pattern' is not in: $(cat stderr)"
}

# picture COMMAND...: makes and compares pictures with OpenEXR only (tests/pictures/main.cpp), independently of the code
# under test. OpenImageIO is used where a test asks what other programs see.
picture() { "$bin/sparselens-pictures" "$@"; }

# traced SCENE WIDTHxHEIGHT [FOLDER]: leaves in the folder (.) what all scripts of a build use, made once in traced/ beside
# its bin/, or in the scratch folder for other tools: center.exr and, of 4 rays too, view_0.exr to view_3.exr at the rim of
# the lens; their ldi.exr; rays_1.exr and rays_2.exr, of 32 rays together, and reference.exr, of 256, through the lens.
traced() {
    local all=${bin%/*}/traced made aside
    [ -w "${bin%/*}/CMakeCache.txt" ] || all=$scratch/.traced
    made=$all/$1-$2-$(stat -Lc %.Y "$bin/dof-trace" "$bin/ldi-warp" "$source_dir/tests/tools/check.sh" | cksum | cut -d ' ' -f 1)
    if [ ! -d "$made" ]; then
        mkdir -p "$all"
        aside=$(mktemp -d "$all/.aside.XXXXXX")
        exits 0 "$bin/dof-trace" "$1" --size "$2" --spp 4 --halves 32 --reference 256 -o "$aside"
        exits 0 "$bin/ldi-warp" "$aside/center.exr" "$aside"/view_?.exr -o "$aside/ldi.exr"
        find "$all" -maxdepth 1 -name "$1-$2-*" ! -path "$made" -exec rm -r {} + # of older tools
        mv -T "$aside" "$made" 2>/dev/null || rm -rf "$aside" # another script was faster
    fi
    mkdir -p "${3:-.}"
    cp "$made"/*.exr "${3:-.}"
}

# answers_help TOOL [ARGUMENTS...]: --help and --version work, and an unknown option after the tool's required arguments
# is a usage error.
answers_help() {
    local tool=$1
    shift
    exits 0 "$bin/$tool" --help
    grep -q -e --version stdout || fail "$tool --help does not name --version"
    exits 0 "$bin/$tool" --version
    grep -q "^$tool " stdout || fail "$tool --version does not name the tool: $(cat stdout)"
    fails_saying 2 no-such-option "$bin/$tool" "$@" --no-such-option
}

# pypi NAME: installs a package of PyPI for the Python that is then $pypi_python; or skips.
pypi() {
    python3 -c 'import ensurepip' 2>/dev/null || skip "needs python3-venv"
    python3 -m venv "pypi-$1"
    "pypi-$1"/bin/pip -q --disable-pip-version-check install --retries 1 "$1" >installed 2>&1 ||
        skip "$1: PyPI cannot be reached, or has no wheel for this Python"
    pypi_python=$PWD/pypi-$1/bin/python
}

# usd_python: the Python with USD's library, for the tools, too.
usd_python() {
    pypi usd-core
    export SPARSELENS_USD_PYTHON=$pypi_python
}

# The options of the numbers among the looks of a lens, but for the blades, as the table of looks has them.
options_of_looks() {
    "$bin/dof-gather" --help | sed -nE '/^Lens looks:$/,/^Highlights:$/s/^  (--[a-z-]+) [A-Z]{1,3}( .*)?$/\1/p' | grep -v '^--blade'
}

# readme_block LANGUAGE [DOCUMENT]: the contents of all fenced blocks in that language in README.md, or in the document.
readme_block() { sed -n "/^\`\`\`$1\$/,/^\`\`\`\$/{/^\`\`\`/d;p}" "$source_dir/${2:-README.md}"; }
