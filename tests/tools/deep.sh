# What the scripts that test the deep tools share; sourced after check.sh. Leaves the five views of a small fence
# in views/.
for tool in oiiotool idiff exrheader; do
    command -v $tool >/dev/null || skip "needs $tool (openimageio-tools, openexr)"
done
exits 0 "$bin/dof-trace" fence --size 96x54 --spp 1 -o views
rim=(views/view_0.exr views/view_1.exr views/view_2.exr views/view_3.exr)

same() { cmp -s "$1" "$2" || fail "$1 and $2 differ: $3"; }
differ() { if cmp -s "$1" "$2"; then fail "$1 and $2 are the same: $3"; fi; }

# same_pixels A B WHY: the channels R, G, B, A are equal, whatever else the files hold.
same_pixels() {
    oiiotool "$1" --ch R,G,B,A -o a.tmp.exr
    oiiotool "$2" --ch R,G,B,A -o b.tmp.exr
    idiff -q -fail 0 -warn 0 a.tmp.exr b.tmp.exr >idiff.txt || fail "$1 and $2 differ: $3 ($(cat idiff.txt))"
}

# same_samples A B WHY, differ_samples A B WHY: of deep files, whatever else they hold.
dump() { oiiotool --dumpdata "$1" | tail -n +2 >"$2"; }
same_samples() {
    dump "$1" a.tmp.txt
    dump "$2" b.tmp.txt
    [ "$(wc -l <a.tmp.txt)" -gt 8 ] || fail "no samples in $1: $(cat a.tmp.txt)"
    same a.tmp.txt b.tmp.txt "$1 and $2: $3"
}
differ_samples() {
    dump "$1" a.tmp.txt
    dump "$2" b.tmp.txt
    differ a.tmp.txt b.tmp.txt "$1 and $2: $3"
}

# says FILE PATTERN: the file's header has it (grep -E).
says() { exrheader "$1" | grep -Eq -e "$2" || fail "$1 does not say '$2': $(exrheader "$1")"; }

# survives_failure TOOL ARGUMENTS...: with arguments that make it fail and -o old.exr, the tool leaves the old
# file as it was and nothing else beside it.
survives_failure() {
    mkdir -p survivor
    echo "the old picture" >survivor/old.exr
    exits 1 "$@" -o survivor/old.exr
    [ "$(cat survivor/old.exr)" = "the old picture" ] || fail "the old output is gone: $*"
    [ "$(ls -A survivor)" = old.exr ] || fail "left behind: $(ls -A survivor)"
}

# refuses_wrong_lenses TOOL ARGUMENTS...: values that are no lens are usage errors, in one line.
refuses_wrong_lenses() {
    local option value
    for option in --focal-length --sensor-width --fstop --focus-distance --scene-unit; do
        for value in abc nan 0 -1 1x; do fails_saying 2 "$option.*$value" "$@" "$option" "$value"; done
    done
    for value in abc nan -0.5 inf; do fails_saying 2 "--lens-radius.*$value" "$@" --lens-radius "$value"; done
    fails_saying 2 '(--fstop.*--lens-radius|--lens-radius.*--fstop)' "$@" --fstop 2 --lens-radius 0.1
    fails_saying 2 '--depth' "$@" --depth sideways
    fails_saying 2 '--threads' "$@" --threads -1
    fails_saying 2 '--fstop' "$@" --fstop
}
