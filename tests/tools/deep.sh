# Shared by the scripts that test the deep tools; sourced after check.sh. Leaves the five views of a small fence in
# views/.
for tool in oiiotool exrheader; do
    command -v $tool >/dev/null || skip "needs $tool (openimageio-tools, openexr)"
done
traced fence 96x54 views
rim=(views/view_0.exr views/view_1.exr views/view_2.exr views/view_3.exr)

same() { cmp -s "$1" "$2" || fail "$1 and $2 differ: $3"; }
differ() { if cmp -s "$1" "$2"; then fail "$1 and $2 are the same: $3"; fi; }

# same_pixels A B WHY: the channels R, G, B, A are equal; other contents of the files do not count.
same_pixels() {
    picture same "$1" "$2" R,G,B,A >found || fail "$3: $(cat found)"
}

# same_samples A B WHY, differ_samples A B WHY: for the samples of deep files; other contents do not count.
same_samples() {
    picture same "$1" "$2" >found || fail "$3: $(cat found)"
    [ "$(total "$1")" -gt 8 ] || fail "no samples in $1"
}
differ_samples() { picture differ "$1" "$2" >found || fail "$3: $(cat found)"; }

# total FILE: the number of all samples; most FILE: the largest number in a pixel.
total() { picture samples "$1" | cut -d ' ' -f 1; }
most() { picture samples "$1" | cut -d ' ' -f 2; }

# says FILE PATTERN: the file's header matches (grep -E).
says() { exrheader "$1" | grep -Eq -e "$2" || fail "$1 does not say '$2': $(exrheader "$1")"; }

# survives_failure TOOL ARGUMENTS...: with arguments that make it fail and -o old.exr, the tool leaves the old file as
# it was and no other file beside it.
survives_failure() {
    mkdir -p survivor
    echo "the old picture" >survivor/old.exr
    exits 1 "$@" -o survivor/old.exr
    [ "$(cat survivor/old.exr)" = "the old picture" ] || fail "the old output is gone: $*"
    [ "$(ls -A survivor)" = old.exr ] || fail "left behind: $(ls -A survivor)"
}

# refuses_wrong_lenses TOOL ARGUMENTS...: impossible lens values are usage errors, in one line.
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
