#!/bin/bash
# Damaged files through every tool that reads EXR: the tool ends by itself within 40 s of a core with exit code 0 or 1,
# a failure is one line on stderr that names the file, memory stays under 1 GB, and an output is whole or missing, and
# an older one untouched. Files: those of ../shared/damaged if they are there, truncations of valid files at every
# kilobyte, and valid files with false headers. Prints the tally.
#
#   bash hostile.sh BIN_DIR [--all | FILE...]     FILE: these files alone. Else five of each kind, or --all (tools.hostile-all)
. "$(dirname "$0")/check.sh"
[ -x /usr/bin/time ] || skip "needs GNU time (time)"
[ -x "$bin/dof-trace" ] || skip "needs dof-trace"
shift
most=5
[ "${1:-}" != --all ] || { most=100000; shift; }
ulimit -c 0
shopt -s nullglob # saves a process per run, with a thousand runs
# The slowest run takes 3.4 s of a core. On a loaded machine that may be minutes, so waits have ten minutes.
seconds=${SPARSELENS_HOSTILE_SECONDS:-40} kilobytes=${SPARSELENS_HOSTILE_KB:-1000000} # sanitizers need more
lens=(--focal-length 36 --sensor-width 36 --focus-distance 5 --lens-radius 0.05)
faults=0 runs=0 failures=0 largest=0
: >tally.txt

fault() {
    faults=$((faults + 1))
    echo "FAULT: $*" >&2
    head -c 600 said >&2
}

# Puts the tool's exit code into $code, its output into the file said, its memory into $memory (KB).
timed() {
    code=0
    (ulimit -t "$seconds" && exec timeout -s KILL 600 /usr/bin/time -q -o memory -f %M "$@" >/dev/null 2>said </dev/null) || code=$?
    memory=0
    [ ! -s memory ] || memory=$(<memory)
    memory=${memory##*$'\n'}
}

errors() { # how many lines are no warnings
    local line number=0
    while IFS= read -r line; do [[ $line = *warning:* ]] || number=$((number + 1)); done <said
    echo $number
}

# hostile FILE TOOL ARGUMENTS...: with -o out/x.exr, where an older output exists.
hostile() {
    local file=$1 tool=$2
    shift 2
    local output=()
    [ "$tool" = dof-compare ] || output=(-o out/x.exr)
    [ -d out ] || mkdir out
    echo old >out/x.exr
    timed "$bin/$tool" "$@" "${output[@]}"
    runs=$((runs + 1))
    echo "$tool exit $code" >>tally.txt
    [ "$memory" -le "$largest" ] || largest=$memory
    [ "$memory" -le "$kilobytes" ] || fault "$tool takes $memory KB: $file"
    case $code in
    0)
        [ "$tool" = dof-compare ] || [ "$tool" = ldi-plan ] || exrheader out/x.exr >/dev/null 2>&1 || fault "$tool writes no picture: $file"
        ;;
    1)
        failures=$((failures + 1))
        [ "$(errors)" = 1 ] || fault "$tool fails in other than one line: $file"
        [[ $(<said) = *"${file##*/}"* ]] || fault "$tool does not name the file: $file"
        [ "$(<out/x.exr)" = old ] || fault "$tool harms the old output: $file"
        ;;
    *) fault "$tool ends with $code: $file" ;;
    esac
    local left=(out/* out/.[!.]*)
    [ "${left[*]}" = out/x.exr ] || { fault "$tool leaves ${left[*]}: $file"; rm -rf out; }
}

# In a frame of 65536 pixels, of which the file has 48, blur is in pixels of the frame, and the picture grows by as
# much: to 882x863 by the lens above, which is an ordinary picture. The selective method takes time proportional to the
# area of the blur, so its lens is a fifth as wide.
every_tool() {
    local file=$1
    hostile "$file" dof-gather "$file" "${lens[@]}"
    hostile "$file" dof-gather "$file" "${lens[@]:0:6}" --lens-radius 0.01 --method selective
    hostile "$file" ldi-cluster "$file" "${lens[@]}"
    hostile "$file" ldi-warp "$file" --view 0.05,0 "$file" "${lens[@]}"
    hostile "$file" dof-accumulate --view 0,0 "$file" --view 0.05,0 "$file" --outside transparent "${lens[@]}"
    hostile "$file" ldi-plan "$file" "${lens[@]}"
    hostile "$file" dof-finish "$file" "$file" "$file"
    hostile "$file" dof-compare "$file" "$file" --regions "$file" "${lens[@]}"
}

# truncations FILE NAME: at every kilobyte, and at a few odd sizes.
truncations() {
    local size bytes
    size=$(stat -c %s "$1")
    for bytes in 0 1 4 7 $(seq 1024 1024 $((size - 1))) $((size - 1)); do
        head -c "$bytes" "$1" >"cut/$2-$bytes.exr"
    done
}

# with_bytes FILE OFFSET HEX OUT: the file with other bytes from that offset.
with_bytes() {
    cp "$1" "$4"
    printf '%b' "$(sed 's/../\\x&/g' <<<"$3")" | dd of="$4" bs=1 seek="$2" conv=notrunc status=none
}

# The offset of an attribute's value: after its name, its type (each with its zero) and four bytes of size.
value_of() { # FILE NAME TYPE
    local at
    at=$(grep -obUaP -- "$2\\x00$3\\x00" "$1" | head -n 1 | cut -d: -f1)
    echo $((at + ${#2} + 1 + ${#3} + 1 + 4))
}

lies() { # FILE NAME
    local window=0 name hex
    window=$(value_of "$1" dataWindow box2i)
    # max.x, max.y follow min.x, min.y; little-endian.
    while read -r name hex; do with_bytes "$1" "$window" "$hex" "lie/$2-$name.exr"; done <<END
wide 0000000000000000ffffff7f35000000
tall 00000000000000005f000000ffffff7f
large 0000000000000000ffff0000ffff0000
broad 0000000000000000ffffff001a000000
all 0000008000000080ffffff7fffffff7f
empty 0a0000000a0000000000000000000000
far 00ffff7f00ffff7f5fffff7f35ffff7f
END
    with_bytes "$1" "$(value_of "$1" displayWindow box2i)" 000000c0000000c0ffffff3fffffff3f "lie/$2-display.exr"
    with_bytes "$1" "$(value_of "$1" displayWindow box2i)" 0000000000000000ffff0000ffff0000 "lie/$2-frame.exr"
    with_bytes "$1" "$(value_of "$1" compression compression)" ff "lie/$2-compression.exr"
    with_bytes "$1" "$(value_of "$1" channels chlist)" 5200ffffffff "lie/$2-channel.exr"
    with_bytes "$1" "$(value_of "$1" pixelAspectRatio float)" 0000c07f "lie/$2-aspect.exr"
    with_bytes "$1" "$(($(value_of "$1" dataWindow box2i) - 4))" ffffff7f "lie/$2-size.exr"
}

own_files() {
    mkdir cut lie
    "$bin/dof-trace" fence --size 48x27 --views 1 --spp 1 --deep peel:2 -o valid
    "$bin/ldi-warp" valid/center.exr valid/view_0.exr -o valid/ldi.exr
    truncations valid/center.exr flat
    truncations valid/ldi.exr deep
    truncations "$source_dir/tests/fuzz/corpus/deep_reader/parts.exr" parts
    truncations "$source_dir/tests/fuzz/corpus/flat_reader/views.exr" views
    lies valid/center.exr flat
    lies valid/ldi.exr deep
}

# some FILE...: $most of them, evenly spread from the first to the last, into $chosen.
some() {
    local i
    [ $# -gt $most ] || { chosen=("$@"); return; }
    chosen=()
    for ((i = 0; i < most; ++i)); do chosen+=("${@:1 + i * ($# - 1) / (most - 1):1}"); done
}
every_tool_with() { # FILE...: some of these files
    some "$@"
    for file in "${chosen[@]}"; do every_tool "$file"; done
}

tally() { # NAME FOLDER
    echo "$1: $runs runs, $failures failed as they should, largest memory $((largest / 1024)) MB, faults $faults"
    sort tally.txt | uniq -c | sed 's/^/  /'
    runs=0 failures=0 largest=0
    : >tally.txt
}

# A valid file with more pixels per byte than the memory limit allows: refused, unless --max-memory permits more.
dense_file() {
    picture make dense.exr 3000x2500 R=0 G=0 B=0 A=1 Z=5 half=R,G,B,A
    fails_saying 1 'dense.exr: asks for [0-9]+ MB of memory.*--max-memory' "$bin/dof-gather" dense.exr -o x.exr --lens-radius 0
    exits 0 "$bin/dof-gather" dense.exr -o x.exr --lens-radius 0 --max-memory 1GB
    fails_saying 1 'dense.exr: asks for [0-9]+ MB of memory' "$bin/dof-gather" dense.exr -o x.exr --lens-radius 0 --max-memory 100MB
    fails_saying 2 '--max-memory' "$bin/dof-gather" dense.exr -o x.exr --max-memory much
    rm dense.exr x.exr
}

if [ $# -gt 0 ]; then
    for file; do every_tool "$file"; done
    tally "given files"
else
    own_files
    every_tool valid/center.exr # some succeed with this
    for kind in cut/{flat,deep,parts,views}- lie/{flat,deep}-; do every_tool_with "$kind"*; done
    tally "own files"
    dense_file
    damaged=$source_dir/../shared/damaged
    if [ -d "$damaged" ]; then
        every_tool_with "$damaged"/*
        tally "shared/damaged"
    else
        echo "skipped: ../shared/damaged is not there"
    fi
fi
[ "$faults" -eq 0 ] || fail "$faults faults"
