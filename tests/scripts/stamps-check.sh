# tests/scripts/stamps.sh finds stamps that name no commit, and tables older than their code. bash stamps-check.sh
set -euo pipefail
script=$(realpath "$(dirname "$0")/stamps.sh")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$scratch/project"/{tests/scripts,src/dof,lab/measures,lab/results,docs}
cd "$scratch/project"
fail() {
    echo "FAIL: $*" >&2
    exit 1
}
committed() { git add -A && git -c user.name=test -c user.email=test commit -qm "$1" && git rev-parse --short=10 HEAD; }
stamps() { bash tests/scripts/stamps.sh "$@"; }
refused() { # PATTERN OPTION...
    ! stamps "${@:2}" 2>said || fail "stamps.sh ${*:2} passes, which should say '$1'"
    grep -q -e "$1" said || fail "'$1' is not in: $(cat said)"
}
page() { # COMMIT
    printf '%s\n' '<!-- measured: a 0 -->' "\`lab/measure a\`: commit $1, 2026-01-01, 2 cores." '' 'figures' '<!-- end -->' 'prose' >lab/results/a.md
}
git init -q
cp "$script" tests/scripts/
echo '[measured](lab/results/a.md)' >README.md
echo text >docs/README.md
echo '# Measures.' >lab/measures/a.sh
echo 'int x = 1; // one' >src/dof/x.cpp
first=$(committed first)
page "$first"
stamps || fail "a table of today's code"
stamps --strict || fail "a table of today's code"
echo 'int x = 1; // a better word' >src/dof/x.cpp
committed comment >/dev/null
stamps --strict || fail "a comment has changed alone"

echo 'int x = 2;' >src/dof/x.cpp
refused 'should "Changed since: src/dof."'
stamps --write
[ "$(sed -n '/^<!-- end/{n;p}' lab/results/a.md)" = 'Changed since: src/dof.' ] || fail "--write makes $(cat lab/results/a.md)"
stamps || fail "what --write wrote"
refused 'lab/results/a.md, which README.md stands on' --strict
echo '# Code: src/io' >>lab/measures/a.sh
refused 'should ""'
stamps --write
[ "$(tail -n 2 lab/results/a.md | head -n 1)" = '<!-- end -->' ] || fail "--write leaves $(cat lab/results/a.md)"
second=$(committed second)

page 0cb9f7dcec
refused 'names 0cb9f7dcec, which is no commit of this history'
page "$second with changes"
refused 'not committed'
echo '2026-01-01, 0cb9f7d' >docs/README.md
page "$second"
refused 'docs/README.md names 0cb9f7d'
echo text >docs/README.md

git clone -q --depth 1 "file://$PWD" ../shallow
cd ../shallow
[[ $(stamps) == 'skipped: stamps: the clone is shallow'* ]] || fail "in a shallow clone: $(stamps)"
refused 'cannot be judged' --strict
