#!/bin/bash
# Every option of every tool is in --help, in the manual page, in the completion, and in a script that shows its effect;
# options that tools share are tested here, for each tool.
declare -A ending=([ldi-plan]=json)
. "$(dirname "$0")/check.sh"
scripts=("$source_dir"/tests/tools/*.sh "$source_dir"/lab/tests/tools/*.sh)
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
declare -A shown # "TOOL OPTION": its effect was tested here

# judged PATTERN FILE...: a line that matches, in a run that should succeed, is followed within eight lines by one that
# checks the result, or does both itself. A run that should fail shows no effect.
judged() {
    PATTERN=$1 awk '
        FNR == 1 { left = 0 }
        /^ *#/ || /fails_saying|survives_failure|exits [12]|expected=1/ { next }
        $0 ~ ENVIRON["PATTERN"] { left = 9 }
        left-- > 0 && /(^|[^a-z])(fail|same|same_[a-z]*|differ|differ_[a-z]*|within|holds|is|positive|says|agree|fewer|changes|changes_[a-z]*|changed|chosen|regions|expect_window|history|said|silent|check|show|newer) / { found = 1 }
        END { exit !found }' "${@:2}"
}
# tested OPTION TOOL: its effect is tested here, or the tool's own script runs it with that option and checks the
# result, or another script does with the tool's name.
tested() {
    local option="(^|[^a-z-])$1([^a-z-]|\$)" own=$source_dir/tests/tools/$2.sh
    [ -e "$own" ] || own=$source_dir/lab/tests/tools/$2.sh
    [ -n "${shown[$2 $1]:-}" ] || judged "$option" "$own" || judged "bin/$2.*$option" "${scripts[@]}"
}
if tested --no-such-option dof-gather; then fail "an option of runs that fail counts as tested"; fi

# --- Options that tools share, for each tool that has them ---

trace() { exits 0 "$bin/dof-trace" fence --size 48x27 --spp 1 -o "$@"; }
trace views --views 1
exits 0 "$bin/ldi-warp" views/center.exr views/view_0.exr -o ldi.exr
trace rays --views 0 --halves 2
exits 0 "$bin/ldi-plan" views/center.exr --noise 0 --lens-radius 0.5 --masks masks -o plan.json
for frame in 1 2 4; do cp ldi.exr in.000$frame.exr && cp views/center.exr center.000$frame.exr; done
# What each tool does with one input, without the output; %FRAME% is empty, or stands for the frame.
declare -A task=(
    [ldi-plan]="center%FRAME%.exr --noise 0 --lens-radius 0.5" [ldi-warp]="center%FRAME%.exr" [ldi-cluster]="in%FRAME%.exr --tolerance 1"
    [dof-gather]="in%FRAME%.exr" [dof-finish]="center%FRAME%.exr rays/rays_1.exr rays/rays_2.exr" [dof-trace]="fence --plan plan.json --size 48x27" [dof-accumulate]="center.exr"
    [dof-compare]="center.exr views/view_0.exr --json --regions in.exr"
)
cp ldi.exr in.exr
cp views/center.exr center.exr
# run TOOL OUTPUT OPTIONS...: runs the task; for dof-compare the output is what it prints.
run() {
    local tool=$1 output=(-o "$2")
    [ "$tool" != dof-compare ] || output=()
    # shellcheck disable=SC2086
    exits "${expected:-0}" "$bin/$tool" ${task[$tool]//%FRAME%/${frame_name:-}} "${output[@]}" "${@:3}"
    [ "$tool" != dof-compare ] || mv stdout "$2"
}
show() { for option in "${@:2}"; do shown[$1 $option]=yes; done; }
# looks.sh tests the numbers of the looks, as --help has them, for each tool that takes them.
for tool in dof-gather dof-trace dof-view; do
    # shellcheck disable=SC2046
    show $tool $(options_of_looks)
done

for tool in "${!task[@]}"; do
    run "$tool" out.$tool.${ending[$tool]:-exr} --threads 3 -v
    grep -qx "$tool: threads: 3" stderr || fail "$tool --threads 3 -v: $(cat stderr)"
    expected=1 run "$tool" none.$tool.${ending[$tool]:-exr} --max-memory 1KB
    grep -q 'asks for .* of memory, more than --max-memory allows' stderr || fail "$tool --max-memory: $(cat stderr)"
    show "$tool" --threads -v --max-memory
done
fails_saying 1 'dof-gather: .* asks for .* than --max-memory allows' "$bin/dof-report" --quick fence --size 24x16 -o report --max-memory 1KB
show dof-report --max-memory

# --far: depths there or beyond are sky.
for tool in ldi-plan ldi-warp ldi-cluster dof-gather dof-compare; do
    run $tool near.$tool.${ending[$tool]:-exr} --far 1e9
    cmp -s near.$tool.${ending[$tool]:-exr} out.$tool.${ending[$tool]:-exr} || fail "$tool --far changes what has no sky"
    run $tool far.$tool.${ending[$tool]:-exr} --far 6
    if cmp -s far.$tool.${ending[$tool]:-exr} out.$tool.${ending[$tool]:-exr}; then fail "$tool --far changes nothing"; fi
    show $tool --far
done

# Frames, with the third missing.
count() { find . -maxdepth 1 -name "$1" -printf x | wc -c; }
for tool in ldi-plan ldi-warp ldi-cluster dof-gather dof-finish; do
    frame_name=.# run $tool frame.#.$tool.${ending[$tool]:-exr} --frames 1-4x3
    [ "$(count "frame.*.$tool.${ending[$tool]:-exr}")" -eq 2 ] || fail "$tool --frames 1-4x3: $(ls)"
    frame_name=.# run $tool frame.#.$tool.${ending[$tool]:-exr} --frames 1,2,4 --skip-existing -v --progress plain
    [ "$(grep -c 'exists$' stderr)" -eq 2 ] || fail "$tool --skip-existing: $(cat stderr)"
    grep -qx "$tool: 100%" stderr || fail "$tool --progress: $(cat stderr)"
    frame_name=.# expected=1 run $tool bad.#.$tool.${ending[$tool]:-exr} --frames 1-4
    [ "$(count "bad.*.$tool.${ending[$tool]:-exr}")" -eq 2 ] || fail "$tool goes on after a frame that fails: $(ls)"
    frame_name=.# expected=1 run $tool bad.#.$tool.${ending[$tool]:-exr} --frames 1-4 --skip-bad-frames
    [ "$(count "bad.*.$tool.${ending[$tool]:-exr}")" -eq 3 ] || fail "$tool --skip-bad-frames: $(ls)"
    show $tool --frames --skip-existing --progress --skip-bad-frames
done

# --- All options of all tools ---

. "$source_dir/tools/completion.sh"
bash_words() { # TOOL [PREVIOUS] WORD: the completions for the last word
    _sparselens "$bin/$1" "${*: -1}" "${*: -2:1}"
    echo "${COMPREPLY[*]}"
}

# has_page TOOL: the manual page has what --help, in stdout, has, each option with its text; man can format it.
has_page() {
    local page=$bin/../share/man/man1/$1.1
    sed -n '/^\.TP$/{n;p}' "$page" | grep -oE '\\fB(\\-)+[^\]+(\\-[^\]+)*' | sed 's/\\fB//; s/\\-/-/g' | sort -u |
        diff names - >differ || fail "$1: help and manual page: $(cat differ)"
    ! grep -n '^\.HP\|^[^.].*:INT in\|REQUIRED\|Excludes:\|Needs:\|Env:' "$page" || fail "$1: the manual page is not readable"
    groff -man -Tascii -P-cbou -ww -rLL=200n "$page" 2>warnings | sed 's/^ *//' >page.txt || fail "$page: $(cat warnings)"
    [ ! -s warnings ] || fail "$page: $(cat warnings)"
    grep -qx "$1 - [A-Z].*" page.txt && grep -qx CUE_THREADS page.txt || fail "$1: name and environment: $(cat page.txt)"
    [ "$(grep "^$1 \[OPTIONS\]" page.txt | grep -o ' -' | wc -l)" -eq "$(grep -cE '^ +-.* REQUIRED' stdout)" ] ||
        fail "$1: the synopsis lacks a required option: $(head -n 9 page.txt)"
}

for path in "$bin"/ldi-* "$bin"/dof-*; do
    tool=${path##*/}
    complete -p "$tool" >/dev/null 2>&1 || fail "$tool has no completion"
    exits 0 "$path" --version
    grep -q "^$tool " stdout || fail "$tool --version: $(cat stdout)"
    exits 0 "$path" -h
    mv stdout short_help
    exits 0 "$path" --help
    cmp -s stdout short_help || fail "$tool: -h and --help differ"
    show "$tool" --help --version
    # "-v,--verbose", and of CLI11 2.6 "-v,     --verbose"
    grep -oE '^  +(-[a-z], +)?-[^ ]+' stdout | tr -d ' ' >options
    tr ',' '\n' <options | sort -u >names
    [ "$(wc -l <names)" -ge 8 ] || fail "$tool --help names $(cat names)"
    bash_words "$tool" - | tr ' ' '\n' | sort -u | diff names - >differ || fail "$tool: help and completion: $(cat differ)"
    ! command -v help2man >/dev/null || has_page "$tool"
    # An option with two names is tested by one of them.
    while IFS=, read -r one two; do
        tested "$one" "$tool" || { [ -n "$two" ] && tested "$two" "$tool"; } || fail "$tool: no script shows what $one $two does"
    done <options
done

command -v help2man >/dev/null || echo "skipped: the manual pages: help2man is not installed"
[ "$(bash_words dof-gather --method s)" = "selective scatter" ] || fail "--method: $(bash_words dof-gather --method s)"
[ "$(bash_words dof-gather --focus-d)" = "--focus-distance" ] || fail "--focus-d: $(bash_words dof-gather --focus-d)"
[ -z "$(bash_words dof-gather in)" ] || fail "names of files are bash's: $(bash_words dof-gather in)"
