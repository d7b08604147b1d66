#!/bin/bash
# No two types share a name in one namespace, because a program that links both would use either. Types in unnamed
# namespaces do not count. tests/lto.sh finds clashes that this does not, such as functions.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

# defined FILE...: prints each NAMESPACE::NAME that is defined again, and where.
defined() {
    awk '
    FNR == 1 { spaces = unnamed = "" }
    /^namespace \{/ { unnamed = 1; next }
    /^\} \/\/ namespace$/ { unnamed = ""; next }
    match($0, /^namespace [A-Za-z0-9_:]+ \{/) { spaces = spaces "::" $2; next }
    /^\} \/\/ namespace ./ { sub("::" $4 "$", "", spaces); next }
    unnamed == "" && match($0, /^(struct|class|enum|enum class|union) [A-Za-z0-9_]+[^;<]*\{/) {
        name = $1 == "enum" && $2 == "class" ? $3 : $2
        if (name ~ /::/) next # the members of a class that its header declares
        sub(/[:{].*/, "", name)
        full = spaces "::" name
        place = FILENAME ":" FNR
        if (full in first) print substr(full, 3) ": " first[full] " and " place
        first[full] = place
    }' "$@"
}

# The check finds what it should.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
printf 'namespace a {\nnamespace {\nstruct Mine {\n};\n} // namespace\nstruct Twice : Base {\n};\nenum class Kind { x };\nstruct Other;\n} // namespace a\n' >"$scratch/one.h"
printf 'namespace a {\nstruct Mine {\n};\nclass Twice {\n};\nstruct Twice::Impl {\n};\nstruct Other {\n};\n} // namespace a\nnamespace b {\nenum class Kind { y };\n} // namespace b\n' >"$scratch/two.h"
found=$(defined "$scratch/one.h" "$scratch/two.h")
[ "$found" = "a::Twice: $scratch/one.h:6 and $scratch/two.h:4" ] || { echo "names.sh finds: $found"; exit 1; }

mapfile -t files < <(find src tools lab -name '*.h' -o -name '*.cpp' | sort)
[ "${#files[@]}" -gt 500 ] || { echo "only ${#files[@]} files"; exit 1; }
twice=$(defined "${files[@]}")
[ -z "$twice" ] || { echo "two types have one name:"; echo "$twice"; exit 1; }
