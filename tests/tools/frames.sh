#!/bin/bash
# Ranges of frames, existing outputs, progress for farms and threads: the options that all tools of the chain share.
. "$(dirname "$0")/check.sh"
. "$source_dir/tests/tools/deep.sh"
gather=$bin/dof-gather
exits 0 "$bin/ldi-warp" views/center.exr "${rim[@]}" -o ldi.exr
pull=("$gather" ldi.exr -o pull.####.exr --frames 1-24 --focus-distance 1:5.0,24:2.0)
count() { find . -maxdepth 1 -name "$1" -printf x | wc -c; }

# A focus pull over one LDI, which is read once; each frame equals the picture at its own focus distance.
exits 0 "${pull[@]}" -v
[ "$(count 'pull.????.exr')" -eq 24 ] || fail "not 24 frames: $(ls)"
[ "$(grep -c 'reading ldi.exr' stderr)" -eq 1 ] || fail "the LDI is not read once: $(cat stderr)"
exits 0 "$gather" ldi.exr -o last.exr --focus-distance 2
same pull.0024.exr last.exr "the last frame of the pull"
exits 0 "$gather" ldi.exr -o ninth.exr --focus-distance "$(awk 'BEGIN { printf "%.17g", 5 - 3 * 8 / 23 }')"
same_pixels pull.0009.exr ninth.exr "a frame between keys"
differ pull.0001.exr pull.0024.exr "--focus-distance by frame"
exits 0 "$gather" ldi.exr -o stop.##.exr --frames 1-5x2 --fstop 1:0.3,5:3
[ "$(count 'stop.??.exr')" -eq 3 ] || fail "--frames 1-5x2: $(ls)"
exits 0 "$gather" ldi.exr -o one.exr --fstop 3
same stop.05.exr one.exr "--fstop by frame"
exits 0 "$gather" ldi.exr -o radius.%d.exr --frames 1,3 --lens-radius 1:0.06,3:0
exits 0 "$gather" ldi.exr -o one.exr --lens-radius 0
same radius.3.exr one.exr "--lens-radius by frame"

# wait_for PROCESS COMMAND...: waits until the command succeeds; fails if the process ends first.
wait_for() {
    while ! "${@:2}"; do
        kill -0 "$1" 2>/dev/null || "${@:2}" || fail "the tool ended early: ${*:2} ($(cat tool.err))"
        sleep 0.02
    done
}

# Frames of separate files are those of separate runs.
for n in 1 2 3; do exits 0 "$bin/ldi-cluster" ldi.exr -o own.000$n.exr --tolerance $((n * n)); done
exits 0 "$gather" own.####.exr -o range.####.exr --frames 1-3
for n in 1 2 3; do
    exits 0 "$gather" own.000$n.exr -o single.exr
    same range.000$n.exr single.exr "frame $n of files of their own"
done
differ range.0001.exr range.0003.exr "frames of files of their own"
# A frame that fails ends the range, or is left out, and nothing of later frames is written.
for n in 1 2 3 4 5; do cp views/center.exr c.000$n.exr; done
: >c.0003.exr
fails_saying 1 '^ldi-warp: frame 3: .*c.0003.exr' "$bin/ldi-warp" c.####.exr "${rim[@]}" -o w.####.exr --frames 1-5
[ "$(count 'w.????.exr')" -eq 2 ] || fail "frames after one that failed: $(ls)"
fails_saying 1 '^ldi-warp: frame 3: .*c.0003.exr' "$bin/ldi-warp" c.####.exr "${rim[@]}" -o w.####.exr --frames 1-5 --skip-bad-frames
[ "$(count 'w.????.exr')" -eq 4 ] || fail "--skip-bad-frames of ldi-warp: $(ls)"
same w.0001.exr ldi.exr "ldi-warp of frames"
same w.0005.exr ldi.exr "ldi-warp of frames"
rm w.????.exr
# A frame that cannot be written ends the range before the next one is written; --skip-bad-frames continues.
mkdir unwritten.0002.exr
fails_saying 1 'frame 2: .*unwritten.0002.exr' "$gather" ldi.exr -o unwritten.####.exr --frames 1-4
[ "$(find . -name 'unwritten.????.exr' -type f -printf '%f ')" = 'unwritten.0001.exr ' ] || fail "frames after one that was not written: $(ls)"
fails_saying 1 'frame 2: .*unwritten.0002.exr' "$gather" ldi.exr -o unwritten.####.exr --frames 1-4 --skip-bad-frames
[ "$(count 'unwritten.????.exr')" -eq 4 ] && [ -f unwritten.0004.exr ] || fail "--skip-bad-frames: $(ls)"
rm unwritten.000[134].exr
rm -r unwritten.*.exr

# --skip-existing completes an interrupted range, and touches nothing else.
rm pull.*.exr
"${pull[@]}" --lens-samples 4096 2>tool.err &
process=$!
three_are_there() { [ "$(count 'pull.????.exr')" -ge 3 ]; }
wait_for $process three_are_there
kill -KILL $process
wait $process 2>/dev/null || true
before=$(count 'pull.????.exr')
[ "$before" -lt 24 ] || fail "it was not killed in the middle"
ls --full-time pull.0001.exr pull.0002.exr >old.txt
exits 0 "${pull[@]}" --skip-existing -v
[ "$(count 'pull.????.exr')" -eq 24 ] || fail "--skip-existing does not finish the rest: $(ls)"
[ "$(grep -c 'exr exists$' stderr)" -eq "$before" ] || fail "$before frames were there, not $(grep -c 'exr exists$' stderr)"
ls --full-time pull.0001.exr pull.0002.exr | cmp - old.txt || fail "--skip-existing writes what exists"
same pull.0024.exr last.exr "the last frame after --skip-existing"
exits 0 "${pull[@]}" --depth-out depth.####.exr --skip-existing -v
if grep -q 'exists$' stderr; then fail "frames without their depths are left out"; fi
exits 0 "${pull[@]}" -v
if grep -q 'exists$' stderr; then fail "without --skip-existing frames are left out"; fi

# Keys: thousands of them, also in a file; pixels by frame.
seq 0 5000 | awk '{ printf "%s%d:%.3f", (NR > 1 ? "," : ""), $1, 2 + $1 / 10 }' >keys.txt
exits 0 "$gather" ldi.exr -o keys.#.exr --frames 3,7 --focus-distance "$(cat keys.txt)"
exits 0 "$gather" ldi.exr -o one.exr --focus-distance 2.3
same keys.0003.exr one.exr "thousands of keys"
tr , '\n' <keys.txt >focus.txt
for file in keys.txt focus.txt; do
    exits 0 "$gather" ldi.exr -o from.#.exr --frames 3,7 --focus-distance @$file
    same from.0007.exr keys.0007.exr "keys from $file"
done
fails_saying 2 '@focus.txt holds a value for each frame: give --frames' "$gather" ldi.exr -o one.exr --focus-distance @focus.txt
fails_saying 1 'nothing.txt' "$gather" ldi.exr -o from.#.exr --frames 3 --focus-distance @nothing.txt
exits 0 "$gather" ldi.exr -o pixel.#.exr --frames 1-3 --focus-pixel '1:1,0;3:41,30' -v
grep -qx 'dof-gather: the focus distance is .*, the depth of pixel 21,15' stderr || fail "--focus-pixel by frame: $(cat stderr)"
exits 0 "$gather" ldi.exr -o one.exr --focus-pixel 21,15
same pixel.0002.exr one.exr "--focus-pixel by frame"

# Sequences through the chain: numbers from disk, from --frames, from the names; one number for all names.
for frame in 0010 0011 0013; do
    mkdir $frame
    for file in center view_0 view_1; do cp views/$file.exr $frame/$file.$frame.exr; done
done
exits 0 "$bin/ldi-warp" "####/center.####.exr" "####/view_0.####.exr" --view 0,0.06 "####/view_1.####.exr" -o ldi.####.exr --frames 10,11,13
exits 0 "$bin/ldi-warp" views/center.exr views/view_0.exr --view 0,0.06 views/view_1.exr -o one.exr
for frame in 0010 0011 0013; do same ldi.$frame.exr one.exr "ldi-warp at frame $frame"; done
exits 0 "$bin/ldi-cluster" ldi.####.exr -o cluster.####.exr --tolerance 1
exits 0 "$bin/ldi-cluster" one.exr -o less.exr --tolerance 1
[ "$(count 'cluster.*.exr')" -eq 3 ] || fail "the numbers on disk: $(ls)"
same cluster.0013.exr less.exr "ldi-cluster of a sequence"
exits 0 "$gather" cluster.10-11#.exr -o out.1-2%02d.exr --depth-out z.1-2#.exr
[ -e out.01.exr ] && [ -e out.02.exr ] && [ -e z.0002.exr ] || fail "ranges in names: $(ls)"
exits 0 "$bin/ldi-plan" %04d/center.%04d.exr -o plan.#.json --frames 10-11
[ "$(count 'plan.001?.json')" -eq 2 ] || fail "plans of a sequence: $(ls)"

# Every engine's spelling of a range, including negative frames, in --frames and in names.
frames() { # "NUMBERS" COMMAND...: one picture for each number, with that number
    exits 0 "${@:2}"
    [ "$(ls spelt)" = "$(printf '%s.exr\n' $1 | sort)" ] || fail "not $1: ${*:2} ($(ls spelt))"
    rm -r spelt
}
still=("$bin/ldi-cluster" one.exr -o)
frames '1 3 5' "${still[@]}" spelt/%d.exr --frames 1-5:2
frames '1 3 5' "${still[@]}" spelt/%d.exr --frames 1-5x2
frames '1 3 5 6 7' "${still[@]}" spelt/%d.exr --frames 1,3,5-7
frames '1 2 4' "${still[@]}" spelt/%d.exr --frames '1 - 2, 4'
frames '-1 0 1' "${still[@]}" spelt/%d.exr --frames -1-1
frames '-3 -2' "${still[@]}" spelt/%d.exr --frames=-3--2
frames '-001 0001' "${still[@]}" spelt/-1-1:2#.exr
frames '1 3 6 7' "${still[@]}" spelt/1,3,6-7%d.exr
frames '-5 -4' "${still[@]}" spelt/-5--4%d.exr

# A frame that fails ends the work, or is left out; the exit code shows it.
fails_saying 1 '^dof-gather: frame 12: cluster.0012.exr: cannot open' "$gather" cluster.#.exr -o bad.#.exr --frames 10-13
[ "$(count 'bad.*.exr')" -eq 2 ] || fail "it goes on after a frame that fails: $(ls bad.*)"
fails_saying 1 'frame 12: cluster.0012.exr' "$gather" cluster.#.exr -o skip.#.exr --frames 10-13 --skip-bad-frames
[ "$(count 'skip.*.exr')" -eq 3 ] || fail "--skip-bad-frames: $(ls skip.*)"

# Wrong usage is reported before the first frame is written.
for text in '--frames abc' '--frames 1-' '--frames 1-2000000' '--frames 1-3 --focus-distance 1:5,1:6' '--progress rings' \
    '--frames 1-3 --focus-distance 1:5,3:-1' '--frames 1-3 --fstop 1:a,2:3'; do
    # shellcheck disable=SC2086
    fails_saying 2 '.' "$gather" ldi.exr -o wrong.#.exr $text
done
fails_saying 2 'wrong.#.exr stands for a sequence.*--frames' "$gather" ldi.exr -o wrong.#.exr
fails_saying 2 'wrong.1-2#.exr has 2 frames, not 3' "$gather" a.1-3#.exr -o wrong.1-2#.exr
fails_saying 2 'wrong.exr would be written 3 times' "$gather" ldi.exr -o wrong.exr --frames 1-3
fails_saying 2 'no.####.exr stands for a sequence' "$gather" no.####.exr -o wrong.exr
[ "$(count 'wrong*')" -eq 0 ] || fail "wrong usage writes $(ls wrong*)"

# No frame's input may be the output of another frame, whether it exists or not.
cp ldi.exr chain.0001.exr
fails_saying 2 'chain.0001.exr would overwrite the input chain.0001.exr' "$bin/ldi-cluster" chain.#.exr -o chain.#.exr --frames 1-2
fails_saying 2 'chain.0002.exr would overwrite the input chain.0002.exr' "$bin/ldi-cluster" chain.1-2#.exr -o chain.2-3#.exr
fails_saying 2 'chain.0002.exr would overwrite the input ./chain.0002.exr' "$bin/ldi-cluster" ./chain.1-2#.exr -o chain.2-3#.exr
cmp -s ldi.exr chain.0001.exr || fail "an input was overwritten"
[ ! -e chain.0002.exr ] || fail "a refused command wrote chain.0002.exr"

# Spelled as in RV and Houdini; a single @ belongs to a name.
exits 0 "$bin/ldi-cluster" cluster.@@@@.exr -o 'houdini.$F4.exr' --tolerance 1 --frames 10-11
[ -e houdini.0010.exr ] && [ -e houdini.0011.exr ] || fail "@@@@ and \$F4: $(ls)"
exits 0 "$bin/ldi-cluster" one.exr -o shot@2x.exr --tolerance 1
[ -e shot@2x.exr ] || fail "a name with an @: $(ls)"

cp ldi.exr 'take#2.exr'
exits 0 "$gather" 'take#2.exr' -o one.exr
exits 0 "$gather" ldi.exr -o two.exr
same one.exr two.exr "a name with a #"

# A folder's name is a name, also with a #; numbers that are left out and keys out of reach are told.
mkdir 'job #12'
for n in -0002 -001 0000 07; do cp ldi.exr "job #12/in.$n.exr"; done
exits 0 "$gather" 'job #12/in.#.exr' -o 'job #12/to.#.exr' --focus-distance 5:3,9:2
[ "$(find . -name 'to.*' | sort | tr '\n' ' ')" = './job #12/to.-001.exr ./job #12/to.-002.exr ./job #12/to.0000.exr ' ] || fail "frames in a folder with a #: $(find . -name 'to.*')"
grep -q 'warning: job #12/in.#.exr leaves out 1 of 4 files .*: job #12/in.%02d.exr takes job #12/in.07.exr' stderr || fail "files left out: $(cat stderr)"
grep -q 'warning: --focus-distance is 3 for all frames: they are -2 to 0' stderr || fail "keys out of reach: $(cat stderr)"
[ "$(wc -l <stderr)" -eq 2 ] || fail "not two warnings: $(cat stderr)"
exits 0 "$gather" 'job #12/in.07.exr' -o 'job #12/one.exr'
same two.exr 'job #12/one.exr' "a folder with a #"

# Progress for farms: over all frames, increasing, each percent once, to the end; nothing by default.
progress() { # FORMAT PATTERN COMMAND...: only lines of the pattern on stderr; its group is the percentage
    local format=$1 pattern=$2
    shift 2
    exits 0 "$@" --progress "$format"
    if grep -Evq "^$pattern\$" stderr; then fail "--progress $format: $(grep -Ev "^$pattern\$" stderr)"; fi
    sed -E "s/^$pattern\$/\1/" stderr >percents
    sort -nuc percents || fail "--progress $format does not grow: $(cat percents)"
    [ "$(tail -1 percents)" -eq 100 ] || fail "--progress $format ends at $(tail -1 percents)"
}
pull=("$gather" ldi.exr -o pull.####.exr --frames 1-4 --focus-distance 1:5.0,4:2.0)
progress plain 'dof-gather: ([0-9]+)%' "${pull[@]}"
progress alf 'ALF_PROGRESS ([0-9]+)%' "${pull[@]}" --skip-existing
for percent in 25 50 75; do grep -qx $percent percents || fail "frames that exist do not count: $(cat percents)"; done
exits 0 "${pull[@]}" --progress openjd
grep -v '^openjd_status: ' stderr >percents
if grep -Evq '^openjd_progress: [0-9]+$' percents; then fail "--progress openjd: $(cat stderr)"; fi
[ "$(tail -1 percents)" = 'openjd_progress: 100' ] || fail "--progress openjd ends at $(tail -1 percents)"
grep -qx 'openjd_status: dof-gather: frame 2 (2 of 4): gathering' stderr || fail "openjd_status: $(cat stderr)"
[ "$(grep -c gathering stderr)" -eq 4 ] || fail "not one openjd_status a stage: $(cat stderr)"
exits 0 "$bin/ldi-warp" views/center.exr "${rim[@]}" -o x.exr --progress openjd
grep -qx 'openjd_status: ldi-warp: warping' stderr || fail "openjd_status without frames: $(cat stderr)"
fails_saying 1 '^openjd_fail: dof-gather: no.exr: cannot open' "$gather" no.exr -o x.exr --progress=openjd
fails_saying 1 '^dof-gather: no.exr: cannot open' "$gather" no.exr -o x.exr --progress alf
fails_saying 1 '^openjd_fail: dof-gather: frame 3: no.0003.exr' "$gather" no.#.exr -o x.#.exr --frames 3 --progress openjd
fails_saying 2 '^openjd_fail: dof-gather: .*no-such' "$gather" ldi.exr -o x.exr --no-such --progress openjd
fails_saying 2 '^openjd_fail: dof-gather: --frames' "$gather" ldi.exr -o x.#.exr --frames abc --progress openjd
progress alf 'ALF_PROGRESS ([0-9]+)%' "$bin/ldi-cluster" ldi.exr -o x.exr
progress plain 'ldi-plan: ([0-9]+)%' "$bin/ldi-plan" views/center.exr -o x.json
exits 0 "${pull[@]}"
[ ! -s stderr ] || fail "talks without being asked: $(cat stderr)"

# On a terminal, once five seconds are over. The input comes late, so that nothing need take long.
late() { # SECONDS NAME COMMAND...: what the command, which reads NAME.late, shows on a terminal is left in NAME.shown
    mkfifo "$2.late"
    { exec 3>"$2.late" && sleep "$1" && cat ldi.exr >&3; } & # from when the tool opens it
    python3 -c 'import pty, sys; pty.spawn(sys.argv[1:])' "${@:3}" </dev/null >"$2.shown" &
}
late 5.5 gather "$gather" gather.late -o gather.exr
late 5.5 none "$gather" none.late -o none.exr --progress none
wait
grep -q 'dof-gather: gathering 100%' gather.shown || fail "no progress on a terminal: $(cat gather.shown)"
if grep '[0-9]%' none.shown; then fail "--progress none: $(cat none.shown)"; fi

# Threads: --threads, else $CUE_THREADS, else all that the process may use.
threads() { # NUMBER COMMAND...
    local number=$1
    shift
    exits 0 "$@" ldi.exr -o x.exr -v
    grep -qx "dof-gather: threads: $number" stderr || fail "not $number threads: $* ($(cat stderr))"
}
threads 3 "$gather" --threads 3
threads 3 env CUE_THREADS=3 "$gather"
threads 2 env CUE_THREADS=3 "$gather" --threads 2
threads "$(nproc)" env CUE_THREADS=3 "$gather" --threads 0
threads 1 taskset -c "$(taskset -cp $$ | sed -E 's/.*: ([0-9]+).*/\1/')" "$gather"
fails_saying 2 'CUE_THREADS|threads' env CUE_THREADS=many "$gather" ldi.exr -o x.exr
