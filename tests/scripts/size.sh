#!/bin/bash
# Measures the size of the project. First the product: src and tools, without the laboratory: lines and files of C++,
# GLSL and templates of either, includes of own files, and arrows: pairs of folders in src and tools of which one
# includes the other. Then lines: the product's other code (JavaScript, CSS, HTML, Python, shell), the laboratory, all
# tests, plugins, share, and documents. Data and results do not count.
#
#   tests/scripts/size.sh [COMMIT]     of the working tree, or of a commit
#   tests/scripts/size.sh --most       fails if a figure is above its limit in docs/code.md ("Budget")
#   tests/scripts/size.sh --set        writes today's figures there as the limits
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
mode=
case ${1-} in
--most | --set) mode=$1 ;;
?*)
    tree=$(mktemp -d)
    trap 'rm -rf "$tree"' EXIT
    git archive "$1" $(git ls-tree --name-only "$1" src tools lab tests plugins share docs README.md CONTRIBUTING.md) | tar -x -C "$tree"
    cd "$tree"
    ;;
esac

# lines NAME EXTENSIONS PATH... [TEST...]: counts those files, by their extensions or without any; TEST as find has it.
lines() {
    local name=$1 extensions=$2
    shift 2
    printf '%-9s ' "$name"
    { find "$@" -type f -regextype posix-extended -regex ".*(\.($extensions)|/[^.]+)" ! -path '*/corpus/*' ! -path '*/results/*' \
        -exec cat {} + 2>/dev/null || true; } | wc -l
}

figures() {
    # In older commits the laboratory is in src and tools.
    local files other='js|css|html|py|pyi|sh'
    files=$(find src tools -regextype posix-extended -regex '.*\.(cpp|h|comp|glsl|in)' |
        grep -vE '^(src|tools)/lab/|^tools/dof-(trace|report|accumulate)\.cpp$' | sort)
    xargs cat <<<"$files" | awk 'END { print "lines     " NR }'
    echo "files     $(wc -l <<<"$files")"
    xargs grep -H '^#include "' <<<"$files" | awk -F'[:"]' -v all="$files" '
    BEGIN { while (split(all, names, "\n") > n) there[names[++n]] = 1 }
    function folder(path) { sub("/[^/]*$", "", path); return path }
    function room(path, parts, n) { n = split(path, parts, "/"); return n > 2 ? parts[1] "/" parts[2] : parts[1] }
    # Beside the file, in tools/ or in src/.
    function included(file, name,    path) {
        path = folder(file) "/" name
        while (sub("[^/]+/[.][.]/", "", path)) continue
        if (path in there) return path
        return (("tools/" name) in there ? "tools/" : "src/") name
    }
    {
        ++includes
        to = room(included($1, $3))
        if (to != room($1) && !arrows[room($1) " " to]++) ++pairs
    }
    END { print "includes  " includes; print "arrows    " pairs }'
    lines scripts "$other" src tools
    local code="cpp|h|c|comp|glsl|in|inc|rs|yaml|gizmo|$other"
    lines lab "$code" lab ! -path 'lab/tests/*'
    lines tests "$code" tests lab/tests
    lines plugins "$code" plugins
    lines share "$code" share
    lines docs md docs README.md CONTRIBUTING.md
}
[ -n "$mode" ] || { figures; exit 0; }

# The limits of docs/code.md: all figures except includes and arrows, which follow from the floors.
document=docs/code.md
now=$(figures | grep -vE '^(includes|arrows) ')
if [ "$mode" = --set ]; then
    sed -i -e '/^```budget$/,/^```$/{//!d}' -e "/^\`\`\`budget\$/r /dev/stdin" $document <<<"$now"
    exit 0
fi

# above FIGURES LIMITS: prints each figure that is above its limit or has none.
above() {
    awk 'NR == FNR { most[$1] = $2; next }
    !($1 in most) { print $1 " has no limit"; next }
    $2 > most[$1] { print $1 " " $2 ", " $2 - most[$1] " more than " most[$1] }' <(echo "$2") <(echo "$1")
}
# The check finds each figure that grows by one, and nothing where none does.
more=$(above "$(awk '{ print $1, $2 + 1 }' <<<"$now")" "$now" | grep -c ', 1 more' || true)
[ -z "$(above "$now" "$now")" ] && [ "$more" -eq "$(wc -l <<<"$now")" ] || { echo "FAIL: size.sh compares wrongly" >&2; exit 1; }
over=$(above "$now" "$(sed -n '/^```budget$/,/^```$/{//!p}' $document)")
[ -z "$over" ] || {
    echo "FAIL: the budget of $document: $(paste -sd ';' <<<"$over" | sed 's/;/; /g'). Shorten it, or lower another and add a row to" \
        "the table there that names the feature that is worth it; then size.sh --set writes the block \`\`\`budget." >&2
    exit 1
}
