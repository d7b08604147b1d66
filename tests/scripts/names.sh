#!/bin/bash
# No two types share a name in one namespace, because a program that links both would use either, and a file could not
# include both. An alias is a type. Types in unnamed namespaces do not count, and the compiler finds two of one file.
# tests/lto.sh finds clashes that this does not, such as functions.
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
    unnamed == "" && (/^(struct|class|enum|enum class|union) [A-Za-z0-9_]+[^;<]*\{/ || /^using [A-Za-z0-9_]+ [^;]*=/) {
        name = $1 == "enum" && $2 == "class" ? $3 : $2
        if (name ~ /::/) next # the members of a class that its header declares
        sub(/[:{].*/, "", name)
        full = spaces "::" name
        place = FILENAME ":" FNR
        if (full in first && file[full] != FILENAME) print substr(full, 3) ": " first[full] " and " place
        first[full] = place
        file[full] = FILENAME
    }' "$@"
}

# The check finds what it should.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cat >"$scratch/one.h" <<'END'
namespace a {
namespace {
struct Mine {};
using Own = int;
} // namespace
struct Twice : Base {};
enum class Kind { x };
struct Other;
using Alias = int;
using std::abs;
} // namespace a
END
cat >"$scratch/two.h" <<'END'
namespace a {
struct Mine {
    using Alias = int;
};
class Twice {};
struct Twice::Impl {};
struct Other {};
using Own =
    int;
using Own = int;
using Alias [[gnu::vector_size(16)]] = float;
using std::abs;
} // namespace a
namespace b {
enum class Kind { y };
} // namespace b
END
found=$(cd "$scratch" && defined one.h two.h)
[ "$found" = $'a::Twice: one.h:6 and two.h:5\na::Alias: one.h:9 and two.h:11' ] || { echo "names.sh finds: $found"; exit 1; }

mapfile -t files < <(find src tools lab -name '*.h' -o -name '*.cpp' | sort)
[ "${#files[@]}" -gt 500 ] || { echo "only ${#files[@]} files"; exit 1; }
twice=$(defined "${files[@]}")
[ -z "$twice" ] || { echo "two types have one name:"; echo "$twice"; exit 1; }
