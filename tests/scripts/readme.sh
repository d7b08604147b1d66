# README.md keeps its word: scripts it names exist, tools it names are built, and its shell examples run, in the
# order they stand in, in an empty folder.
#   bash readme.sh BIN_DIR
. "$(dirname "$0")/../tools/check.sh"
readme=$source_dir/README.md

readme_block sh >commands
grep -q . commands || fail "README.md has no shell examples"
for script in ./tools/demo.sh ./tests/run.sh; do
    grep -qF "$script" commands || fail "README.md does not name $script"
done
grep -E '^\./' commands | while read -r script _; do
    [ -x "$source_dir/$script" ] || fail "README.md names $script, which is no executable script"
done
grep -oE '\]\([^):#]+' "$readme" | cut -c 3- | while read -r link; do
    [ -e "$source_dir/$link" ] || fail "README.md links to $link, which is not there"
done
grep -ohE '\b(ldi|dof)-[a-z]+\b' "$readme" | sort -u | while read -r tool; do
    [ -x "$bin/$tool" ] || fail "README.md names $tool, which is not built"
done
grep -vE '^\./' commands >example
PATH=$bin:$PATH bash -euo pipefail example >stdout 2>stderr </dev/null || fail "the README's examples: $(cat stderr)"
