#!/bin/bash
# Checks that the figures of the documents were measured on the current code.
#
#   tests/scripts/stamps.sh            each table of lab/measure names a commit of this history, and what changed since
#   tests/scripts/stamps.sh --write    writes after each table which code changed since
#   tests/scripts/stamps.sh --strict   besides: nothing changed since for the pages that README.md links to
#
# A table depends on the code of gathering and tracing, or on the paths after "# Code:" in its lab/measures/PAGE.sh.
# Comments and spaces do not count. If code has changed, the line after the table says "Changed since: FOLDERS."
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
mode=${1-}
code='src/base src/deep src/dof src/kernels src/lens src/looks src/plan src/view src/warp lab/trace'
fail() {
    echo "FAIL: $*" >&2
    exit 1
}
no_history() { # WHY
    [ "$mode" != --strict ] || fail "stamps cannot be judged: $*"
    echo "skipped: stamps: $*"
    exit 0
}
[ "$(git rev-parse --is-shallow-repository 2>/dev/null || true)" != true ] || no_history "the clone is shallow (git fetch --unshallow)"
git rev-parse -q --verify HEAD >/dev/null 2>&1 || no_history "there is no git history here"

bare() { sed 's@//.*@@' | tr -d '[:space:]'; }
# changed COMMIT PATH...: the folders, two levels deep, whose code differs from that commit's.
changed() {
    local file folder found=' '
    while read -r file; do
        folder=$(cut -d / -f 1,2 <<<"$file")
        [[ $found != *" $folder "* ]] || continue
        [ "$(git show "$1:$file" 2>/dev/null | bare)" = "$(bare 2>/dev/null <"$file")" ] || found+="$folder "
    done < <(git diff --name-only "$1" -- "${@:2}" | grep -E '\.(cpp|h|comp|glsl)$')
    echo $found
}
# since PAGE COMMIT: the line that belongs after that table; empty if its code is current.
since() {
    local of folders
    of=$(sed -n 's/^# Code: //p' "lab/measures/$1.sh")
    folders=$(changed "$2" ${of:-$code})
    [ -z "$folders" ] || echo "Changed since: ${folders// /, }."
}

for document in README.md docs/*.md lab/results/*.md; do
    while read -r commit; do
        git merge-base --is-ancestor "$commit" HEAD 2>/dev/null || fail "$document names $commit, which is no commit of this history"
    done < <(grep -oE '(commit |[0-9]{4}-[0-9]{2}-[0-9]{2}, )[0-9a-f]{7,40}\b' "$document" | awk '{ print $NF }' | sort -u)
    while read -r page commit rest; do
        [[ $rest != "with changes"* ]] || fail "$document: $page was measured on code that was not committed"
        line=$(since "$page" "$commit")
        [ "$mode" != --strict ] || [ -z "$line" ] || ! grep -qF "($document)" README.md ||
            fail "$document, which README.md stands on: $page was measured on $commit. $line Measure it anew: lab/measure $page"
        said=$(awk -v page="$page" '$1 == "<!--" && $3 == page { inside = 1 } after { if (/^Changed since: /) print; exit }
            inside && $0 == "<!-- end -->" { after = 1 }' "$document")
        [ "$said" != "$line" ] || continue
        [ "$mode" = --write ] || fail "$document: $page says \"$said\" after its table, and should \"$line\": tests/scripts/stamps.sh --write"
        awk -v page="$page" -v line="$line" '
            after { after = 0; if (/^Changed since: /) next }
            { print }
            $1 == "<!--" && $3 == page { inside = 1 }
            inside && $0 == "<!-- end -->" { inside = 0; after = 1; if (line) print line }' "$document" >"$document.new"
        cat "$document.new" >"$document"
        rm "$document.new"
    done < <(sed -nE 's/^`lab\/measure ([a-z-]+)`: commit ([0-9a-f]{7,40}),? ?([^,]*).*/\1 \2 \3/p' "$document")
done
