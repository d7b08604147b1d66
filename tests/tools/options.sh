#!/bin/bash
# Every option of every tool is in --help, in the manual page, in the completion, and in a script that tests it.
. "$(dirname "$0")/check.sh"
scripts=$source_dir/tests/tools
shared=("$scripts/check.sh" "$scripts/frames.sh" "$scripts/hostile.sh" "$scripts/options.sh" "$scripts/stats.sh") # for options that tools share

# tested OPTION TOOL: the tool's script has it, or one for options that tools share, or a line that runs the tool.
tested() {
    local option="(^|[^a-z-])$1([^a-z-]|\$)"
    grep -Eqe "$option" "$scripts/$2.sh" "${shared[@]}" || grep -Eqe "bin/$2.*$option" "$scripts"/*.sh
}

bash_words() { # TOOL WORDS...: what the completion offers for the last word
    bash -c '. "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); "_${1//-/_}"; echo "${COMPREPLY[*]}"' - "$folder/$1" "$@"
}

folder=$PWD/completions
mkdir completions
for path in "$bin"/ldi-* "$bin"/dof-*; do
    tool=${path##*/}
    exits 0 "$path" --man
    [ ! -s stderr ] || fail "$tool --man says $(cat stderr)"
    mv stdout "$tool.1"
    grep -q '^\.SH NAME' "$tool.1" && grep -qi "^\.TH $tool 1" "$tool.1" || fail "$tool: no manual page"
    cmp -s "$tool.1" "$bin/../share/man/man1/$tool.1" || fail "$tool: the built manual page is another"
    exits 0 "$path" --completion bash
    mv stdout "completions/$tool"
    cmp -s "completions/$tool" "$bin/../share/bash-completion/completions/$tool" || fail "$tool: the built completion is another"
    for shell in zsh fish; do
        exits 0 "$path" --completion $shell
        mv stdout "completions/$tool.$shell"
    done
    cmp -s "completions/$tool.zsh" "$bin/../share/zsh/site-functions/_$tool" || fail "$tool: the built completion of zsh is another"
    cmp -s "completions/$tool.fish" "$bin/../share/fish/vendor_completions.d/$tool.fish" || fail "$tool: the built completion of fish is another"
    fails_saying 2 '--completion' "$path" --completion csh

    exits 0 "$path" --help
    grep -oE '^  +-[^ ]+' stdout | tr -d ' ' | tr ',' '\n' | sort -u >names
    [ "$(wc -l <names)" -ge 8 ] || fail "$tool --help names $(cat names)"
    bash_words "$tool" - | tr ' ' '\n' | sort -u | diff names - >differ || fail "$tool: help and completion: $(cat differ)"
    sed -nE "s/^ +'\\*(-[^[]+)\\[.*/\\1/p" "completions/$tool.zsh" | sort -u | diff names - >differ || fail "$tool: help and zsh: $(cat differ)"
    sed -E "s/ -d '.*//" "completions/$tool.fish" | grep -oE ' -[sl] [^ ]+' | sed 's/ -s /-/; s/ -l /--/' | sort -u |
        diff names - >differ || fail "$tool: help and fish: $(cat differ)"
    sed -nE 's/\\fB((\\-)+[^\\]+(\\-[^\\]+)*)\\fR/\n&\n/gp' "$tool.1" | sed -nE 's/^\\fB(\\-.*)\\fR$/\1/p' | sed 's/\\-/-/g' | sort -u |
        diff names - >differ || fail "$tool: help and manual page: $(cat differ)"
    # An option of two names is tested by one of them.
    grep -oE '^  +-[^ ]+' stdout | tr -d ' ' | while IFS=, read -r one two; do
        tested "$one" "$tool" || { [ -n "$two" ] && tested "$two" "$tool"; } || fail "$tool: no script tests $one $two"
    done
done

# The page is one that man can set, and options with words offer them.
if command -v groff >/dev/null; then
    for page in *.1; do
        groff -man -Tutf8 -ww "$page" >page.txt 2>warnings || fail "$page: $(cat warnings)"
        [ ! -s warnings ] || fail "$page: $(cat warnings)"
    done
fi
[ "$(bash_words dof-gather --method s)" = "selective scatter" ] || fail "--method: $(bash_words dof-gather --method s)"
[ "$(bash_words dof-gather --focus-d)" = "--focus-distance" ] || fail "--focus-d: $(bash_words dof-gather --focus-d)"
if command -v zsh >/dev/null; then
    for file in completions/*.zsh; do zsh -fn "$file" || fail "$file is no zsh"; done
fi
if command -v fish >/dev/null; then
    fish_words() { XDG_CONFIG_HOME=$PWD XDG_DATA_HOME=$PWD fish -Nc "source completions/$1.fish; complete -C \"$1 $2\"" | cut -f1 | xargs; }
    [ "$(fish_words dof-gather '--method s')" = "scatter selective" ] || fail "fish: --method: $(fish_words dof-gather '--method s')"
    [ "$(fish_words dof-gather --focus-d)" = "--focus-distance" ] || fail "fish: --focus-d: $(fish_words dof-gather --focus-d)"
fi
[ -z "$(bash_words dof-gather in)" ] || fail "names of files are bash's: $(bash_words dof-gather in)"
