#!/bin/bash
# Measures the size of the product: src and tools, without the laboratory. Lines and files of C++, GLSL and templates of
# either, includes of own files, and arrows: pairs of folders in src and tools of which one includes the other.
#
#   tests/scripts/size.sh [COMMIT]     of the working tree, or of a commit
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if [ $# -gt 0 ]; then
    tree=$(mktemp -d)
    trap 'rm -rf "$tree"' EXIT
    git archive "$1" src tools | tar -x -C "$tree"
    cd "$tree"
fi

# In older commits the laboratory is in src and tools.
files=$(find src tools -regextype posix-extended -regex '.*\.(cpp|h|comp|glsl|in)' |
    grep -vE '^(src|tools)/lab/|^tools/dof-(trace|report|stress|accumulate)\.cpp$' | sort)
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
