# Includes run one way, down the floors that docs/code.md lists: a file includes what lies in its own folder or on a
# lower floor. Public headers, which are installed, include public headers alone, by relative paths, so that one include
# root is enough. No folder of src/ or tools/ holds more than 25 files of its own.
#   bash includes.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
faults=0
fault() {
    echo "FAIL: $*" >&2
    faults=$((faults + 1))
}

# FOLDER NUMBER, the lowest floor first: the lines of the block ```floors.
floors=$(sed -n '/^```floors$/,/^```$/{/^```/d;p}' docs/code.md |
    awk '{ for (i = 1; i <= NF && $i != "#"; ++i) print $i, NR }')
[ -n "$floors" ] || fault "docs/code.md has no block of floors"
declare -A floor_of
while read -r folder number; do
    floor_of[$folder]=$number
    [ -d "$folder" ] || fault "docs/code.md names the folder $folder, which is not there"
done <<<"$floors"

# The file that FILE means by "NAME": beside it, in tools/ or in src/.
included() {
    local path
    for path in "$(dirname "$1")/$2" "tools/$2" "src/$2"; do
        [ -e "$path" ] && { realpath -m --relative-to=. "$path"; return; }
    done
    echo "$2"
}

includes=$(find src tools -name '*.h' -o -name '*.cpp' -o -name '*.cpp.in' | sort |
    xargs grep -oH '^#include "[^"]*"' | sed -E 's/^([^:]*):#include "(.*)"/\1 \2/')
[ "$(wc -l <<<"$includes")" -gt 100 ] || fault "the includes were not found"
while read -r file name; do
    target=$(included "$file" "$name")
    from=$(dirname "$file") to=$(dirname "$target")
    [ "$from" != "$to" ] || continue
    if [ -z "${floor_of[$from]-}" ]; then
        fault "$file: its folder $from is on no floor of docs/code.md"
    elif [ -z "${floor_of[$to]-}" ]; then
        fault "$file includes $name: $to is on no floor of docs/code.md"
    elif [ "${floor_of[$to]}" -ge "${floor_of[$from]}" ]; then
        fault "$file includes $name: $to is not on a lower floor than $from"
    fi
done <<<"$includes"

public=$(sed -n '/^set(SPARSELENS_PUBLIC_HEADERS$/,/^)$/p' src/CMakeLists.txt | grep -oE '[a-z_/0-9]+\.h')
for header in $public; do
    for name in $(sed -nE 's/^#include "(.*)"/\1/p' "src/$header"); do
        path=$(realpath -m --relative-to=src "$(dirname "src/$header")/$name")
        [ -e "src/$path" ] || fault "src/$header includes $name by another root than its own folder"
        grep -qxF "$path" <<<"$public" || fault "src/$header is public and includes $name, which is not"
    done
done

while read -r folder; do
    files=$(find "$folder" -maxdepth 1 -type f | wc -l)
    [ "$files" -le 25 ] || fault "$folder holds $files files of its own (25 at most)"
done < <(find src tools -type d)
exit $((faults > 0))
