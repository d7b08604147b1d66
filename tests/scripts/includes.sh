# Includes run one way, down the floors that docs/code.md lists, of folders and of single files: a file includes files
# of its own folder or of lower floors, and nothing that the same document forbids. Public headers, which are installed,
# include only public headers, by relative paths, so that one include root is enough.
#   bash includes.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

# Prints facts, a keyword and its subject: `floor FOLDER_OR_FILE...`, the lowest first; `never FOLDER...: FOLDER...`;
# `public HEADER`, by its path in src/; `folder PATH`; `file PATH`; `include FILE NAME`; `call FILE LINE NAME`, where a
# front end does what src/chain does for all of them.
facts() {
    sed -n '/^```floors$/,/^```$/{/^```/d;s/#.*//;s/^/floor /;p}' docs/code.md
    sed -n '/^```never$/,/^```$/{/^```/d;s/#.*//;s/:/ &/;s/^/never /;p}' docs/code.md
    sed -n '/^set(SPARSELENS_PUBLIC_HEADERS$/,/^)$/p' src/CMakeLists.txt | grep -oE '[a-z_/0-9]+\.h' | sed 's/^/public /'
    find src/looks -name '*.h' -printf 'public looks/%f\n'
    find src tools lab plugins -path lab/tests -prune -o -type d -printf 'folder %p\n'
    find src tools lab plugins -path lab/tests -prune -o -type f -printf 'file %p\n' | sort
    { grep -rnoE --include=*.cpp --include=*.h '\b(gather_picture|gather_rows|lens_gather|make_plan|with_lens|choose_windows|border_reach)\(|->(gather|light)\(' src/python tools || true; } |
        sed -E 's/^([^:]*):([0-9]*):(.*)\($/call \1 \2 \3/'
    find src tools lab plugins -path lab/tests -prune -o '(' -name '*.h' -o -name '*.c' -o -name '*.cpp' -o -name '*.cpp.in' ')' -print | sort | xargs grep -oH '^#include "[^"]*"' |
        sed -E 's/^([^:]*):#include "(.*)"/include \1 \2/'
}

facts | awk '
function fault(what) {
    print "FAIL: " what >"/dev/stderr"
    ++faults
}
function folder_of(path) { return sub("/[^/]*$", "", path) ? path : "." }
# The path without "." and "..".
function normal(path,    parts, n, i, kept, result) {
    n = split(path, parts, "/")
    kept = 0
    for (i = 1; i <= n; ++i) {
        if (parts[i] == "" || parts[i] == ".") continue
        if (parts[i] == ".." && kept > 0 && parts[kept] != "..") --kept
        else parts[++kept] = parts[i]
    }
    for (i = 1; i <= kept; ++i) result = result (i > 1 ? "/" : "") parts[i]
    return result
}
# The file that FILE means by "NAME": beside it, in tools/, in src/ or as it stands.
function included(file, name,    path) {
    path = normal(folder_of(file) "/" name)
    if (path in is_file) return path
    path = normal("tools/" name)
    if (path in is_file) return path
    path = normal("src/" name)
    return path in is_file ? path : normal(name)
}
# The entry of the floors that contains a file: the file itself or its folder.
function room_of(path) { return path in floor ? path : folder_of(path) }
function check_floors(file, name,    from, to) {
    from = room_of(file)
    to = room_of(included(file, name))
    if (from == to) return
    if (!(from in floor)) fault(file ": " from " is on no floor of docs/code.md")
    else if (!(to in floor)) fault(file " includes " name ": " to " is on no floor of docs/code.md")
    else if (floor[to] >= floor[from]) fault(file " includes " name ": " to " is not on a lower floor than " from)
}
# Whether PATH is inside one of the folders.
function lies_in(path, folders,    names, n, i) {
    n = split(folders, names, " ")
    for (i = 1; i <= n; ++i) if (index(path "/", names[i] "/") == 1) return 1
    return 0
}
function check_never(file, name,    from, to, i) {
    from = folder_of(file)
    to = folder_of(included(file, name))
    for (i = 1; i <= nevers; ++i)
        if (lies_in(from, never_from[i]) && lies_in(to, never_to[i]) && !lies_in(to, never_from[i]))
            fault(file " includes " name ": that may never be")
}
function check_public(file, name,    path) {
    path = normal(folder_of(file) "/" name)
    if (!(path in is_file)) fault(file " includes " name " by another root than its own folder")
    if (!(path in is_public)) fault(file " is public and includes " name ", which is not")
}
$1 == "floor" { ++floors; for (i = 2; i <= NF; ++i) floor[$i] = floors }
$1 == "never" {
    from = to = $0
    sub(/^never /, "", from)
    sub(/:.*/, "", from)
    sub(/.*:/, "", to)
    never_from[++nevers] = from
    never_to[nevers] = to
}
$1 == "public" { is_public["src/" $2] = 1; ++publics }
$1 == "folder" { is_folder[$2] = 1 }
$1 == "file" { is_file[$2] = 1 }
$1 == "call" { fault($2 ":" $3 " calls " $4 ": ask src/chain") }
$1 == "include" {
    ++includes
    check_floors($2, $3)
    check_never($2, $3)
    if ($2 in is_public) check_public($2, $3)
}
END {
    if (floors == 0) fault("docs/code.md has no block of floors")
    if (nevers == 0) fault("docs/code.md does not say what may never be")
    if (publics == 0) fault("src/CMakeLists.txt names no public headers")
    if (includes <= 100) fault("the includes were not found")
    for (path in floor) if (!(path in is_folder || path in is_file)) fault("docs/code.md names " path ", which is not there")
    for (path in is_public) if (!(path in is_file)) fault("src/CMakeLists.txt names the header " path ", which is not there")
    exit faults > 0
}'

# The map shows these includes.
python3 tests/scripts/folders.py | cmp - docs/folders.svg || {
    echo "FAIL: docs/folders.svg is not the map of today's includes: tests/scripts/folders.py >docs/folders.svg" >&2
    exit 1
}
