#!/bin/bash
# dof-stress from the shell: every case stays within its bound, one line each; lab/results/stress.md names all cases.
. "$(dirname "$0")/../../../tests/tools/check.sh"
answers_help dof-stress
exits 0 "$bin/dof-stress"
[ ! -s stderr ] || fail "complains: $(cat stderr)"
[ "$(wc -l <stdout)" -ge 60 ] || fail "only $(wc -l <stdout) cases"
if grep -v ' pass$' stdout; then fail "not every line ends in pass"; fi
if ! awk '{print $1}' stdout | sort | uniq -d | diff - /dev/null; then fail "two cases of one name"; fi
sed -E 's|^[a-z]+/([^ ]+) .*|\1|' stdout >names
while read -r name; do
    grep -qF "| $name |" "$source_dir/lab/results/stress.md" || fail "lab/results/stress.md lacks $name: run lab/measure stress"
done <names

exits 0 "$bin/dof-stress" --case z_nan
[ "$(wc -l <stdout)" -eq 1 ] && grep -Eq '^depth/z_nan .* pass$' stdout || fail "--case: $(cat stdout)"
exits 0 "$bin/dof-stress" --case depth/z_nan --markdown
grep -Eq '^\| z_nan \| .* \| pass \|$' stdout || fail "--markdown: $(cat stdout)"
fails_saying 2 '--case.*no_such' "$bin/dof-stress" --case no_such
