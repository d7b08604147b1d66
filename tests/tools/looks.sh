#!/bin/bash
# Every number among the looks of a lens, as the table of looks (src/looks/table.h) has them: dof-gather and dof-trace
# agree on what it does, dof-view shows it, and 0 is what a lens without it does.
. "$(dirname "$0")/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
options=$(options_of_looks) # dof-gather.sh and dof-trace.sh test blades, which depend on each other
[ "$(wc -w <<<"$options")" -ge 7 ] || fail "few looks: $options"

reference() { exits 0 "$bin/dof-trace" fence --size 96x54 --views 0 --spp 1 --reference 512 -o "$@"; }
toned=(--ch R,G,B --addc 1 --powc -1) # 1 / (1 + v), so that lamps do not outweigh the rest
# changes WITH WITHOUT TRACED_WITH TRACED_WITHOUT: the mean change of the traced picture by a look, and the mean difference
# between that and the change of the gathered one
changes() {
    oiiotool "$1" "${toned[@]}" "$2" "${toned[@]}" --sub "$3" "${toned[@]}" "$4" "${toned[@]}" --sub --label traced \
        --sub --abs traced --abs --printstats --pop --printstats | awk '/Avg:/ { print $3 + $4 + $5 }'
}

exits 0 "$bin/dof-trace" fence --size 96x54 --views 4 --spp 64 -o .
exits 0 "$bin/ldi-warp" center.exr view_*.exr -o ldi.exr
exits 0 "$bin/dof-gather" ldi.exr -o without.exr --quality final
reference traced
mv traced/reference.exr traced_without.exr
for look in $options; do
    reference traced "$look" 0.5
    exits 0 "$bin/dof-gather" ldi.exr -o with.exr --quality final "$look" 0.5
    { read -r change && read -r error; } < <(changes with.exr without.exr traced/reference.exr traced_without.exr)
    awk -v a="$error" -v b="$change" 'BEGIN { exit !(a < b) }' ||
        fail "$look 0.5 changes the traced picture by $change; the gathered one's change differs from that by $error"
    [ "$look" = --squeeze ] && continue # 1 is none
    exits 0 "$bin/dof-gather" ldi.exr -o none.exr --quality final "$look" 0
    cmp -s none.exr without.exr || fail "$look 0 changes the picture"
done
# shellcheck disable=SC2046
PYTHONDONTWRITEBYTECODE=1 exits 0 python3 "$source_dir/tests/viewing/agree.py" "$bin" ldi.exr $(for look in $options; do echo "$look 0.5"; done)
