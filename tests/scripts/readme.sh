# Checks the documents. README.md is short; relative links resolve; tools and scripts that are named exist; docs/code.md
# finds its functions; the package list equals the build's; and the shell examples of README.md and docs/*.md run, in
# order, in a scratch folder for each document.
#   bash readme.sh BIN_DIR
. "$(dirname "$0")/../tools/check.sh"
readme=$source_dir/README.md
cd "$source_dir"
documents=(README.md CONTRIBUTING.md CHANGELOG.md docs/*.md lab/results/*.md share/*/README.md)
scripts=(share/*/*.sh share/*/*.py share/blender/*/*.py share/*/*.yaml)
cd "$scratch"
PATH=$bin:$PATH
OIIO_LIBRARY_PATH=$(dirname "$(find "$bin/../lib" -name dof.imageio.so)")
export OIIO_LIBRARY_PATH

# blocks DOCUMENT LANGUAGE: the contents of all its fenced blocks in that language.
blocks() { sed -n "/^\`\`\`$2\$/,/^\`\`\`\$/{/^\`\`\`/d;p}" "$source_dir/$1"; }

# README.md has at most 600 words, and lines of at most 120 characters except tables and links.
words=$(wc -w <"$readme")
[ "$words" -le 600 ] || fail "README.md has $words words (600 at most)"
long=$(grep -vE '^\||\]\(' "$readme" | LC_ALL=C.UTF-8 grep -nE '^.{121}' || true)
[ -z "$long" ] || fail "README.md has lines of more than 120 characters: $long"

# matches PATTERN FILE: each match once, one per line; no match is not an error.
matches() { grep -ohE "$1" "$2" | sort -u || true; }
# named DOCUMENT: the files and tools that it names exist.
named() {
    matches '\b(src|tools|tests|share|lab)/[A-Za-z0-9_./-]+\.(h|cpp|sh|py|txt)\b' "$source_dir/$1" |
        while read -r file; do
            [[ -e $source_dir/$file || $file == *NAME* ]] || fail "$1 names $file, which is not there"
        done
    matches '(^|[ `|(])(ldi|dof)-[a-z]+\b' "$source_dir/$1" | tr -d ' `|(' | while read -r tool; do
        [ -x "$bin/$tool" ] || fail "$1 names $tool, which is not built"
    done
}

# All named files exist.
for document in "${documents[@]}"; do
    folder=$source_dir/$(dirname "$document")
    matches '\]\([^)]+\)' "$source_dir/$document" | sed -E 's/^\]\(//;s/\)$//;s/#.*//' | while read -r link; do
        [[ -z $link || $link == *://* || -e $folder/$link ]] || fail "$document links to $link, which is not there"
    done
    named "$document"
done
for script in "${scripts[@]}"; do named "$script"; done
# Options exist in a tool's own help, in a script of share/, or in another program.
for tool in "$bin"/ldi-* "$bin"/dof-*; do "$tool" --help; done | grep -oE -e '--[a-z][a-z_-]+' >options
cat "$source_dir"/share/{blender/sparselens_blender/options.py,opencue/submit.py,slurm/submit.sh} >scripts
grep -oE -e "\"--[a-z][a-z_-]+\"" scripts | tr -d '"' >>options
cat >>options <<'END'
--add
--addc
--all
--array
--attrib
--build
--command
--ch
--clamp
--chappend
--flatten
--format-in-place
--gtest_brief
--info
--install
--invert
--mulc
--no-build-isolation
--no-deps
--output-on-failure
--over
--preset
--requeue
--resize
--set
--slow
--source-dir
--system-site-packages
--test-dir
--write
END
for document in "${documents[@]}"; do
    matches '(^|[ `(])--[a-z][a-z_-]+' "$source_dir/$document" | tr -d ' `(' | while read -r option; do
        grep -qxF -e "$option" options || fail "$document names the option $option, which no tool has"
    done
done
for document in "$source_dir"/docs/*.md; do
    name=$(basename "$document")
    [ "$name" = README.md ] || grep -qF "($name)" "$source_dir/docs/README.md" || fail "docs/README.md lacks $name"
done

# The table of docs/code.md: | question | `file` | `function` |
rows=$(sed -nE 's/^\| .* \| `([^`]+)` \| `([^`]+)` \|$/\1 \2/p' "$source_dir/docs/code.md")
[ "$(wc -l <<<"$rows")" -ge 10 ] || fail "docs/code.md has no table of files and functions"
while read -r file name; do
    grep -qw "$name" "$source_dir/$file" || fail "docs/code.md: $file has no $name"
done <<<"$rows"

# The packages for building by hand equal those that the build installs.
packages() { tr -s ' \\\n' '\n' | grep -v '^$' | sort; }
by_script=$(sed -nE "/^build='/,/'\$/{s/^build=//;s/'//g;p}" "$source_dir/tools/install-deps.sh" | packages)
by_hand=$(blocks CONTRIBUTING.md text | sed -n '/apt-get install/,/[^\\]$/{s/.*apt-get install//;p}' | packages)
[ "$by_script" = "$by_hand" ] || fail "CONTRIBUTING.md's packages: $(diff <(echo "$by_script") <(echo "$by_hand"))"

# run DOCUMENT FOLDER: runs its shell examples, except the project's own scripts; traced pictures are small.
run() {
    echo "trap 'echo \"exit status \$?: \$BASH_COMMAND\" >&2' ERR" >"$scratch/example"
    blocks "$1" sh | sed -E '/^\.\//d; /--size/!s/^dof-trace [a-z]+/& --size 160x90/' >>"$scratch/example"
    (cd "$2" && bash -euo pipefail "$scratch/example" >"$scratch/stdout" 2>"$scratch/stderr" </dev/null) ||
        fail "the examples of $1: $(tail -n 5 "$scratch/stdout") $(cat "$scratch/stderr")"
}

blocks README.md sh >commands
for script in ./tools/demo.sh ./tests/run.sh; do
    grep -qF "$script" commands || fail "README.md does not name $script"
    [ -x "$source_dir/$script" ] || fail "README.md names $script, which is no executable script"
done
mkdir readme
run README.md readme

# Documents start where the README's example ends, with smaller pictures.
mkdir start
dof-trace fence --size 160x90 --views 4 --spp 4 -o start/views
ldi-warp start/views/center.exr start/views/view_*.exr -o - | ldi-cluster - -o start/fence.ldi.exr
for document in "${documents[@]:1}"; do
    [ -n "$(blocks "$document" sh)" ] || continue
    echo "examples of $document"
    cp -r start "${document//\//_}"
    run "$document" "${document//\//_}"
done
# Checks what docs/comp.md says of its pictures.
(cd docs_comp.md && bash "$source_dir/tests/scripts/comp.sh" "$bin")
