#!/bin/sh
# Prints the manual page of a tool: tools/man-page.sh TOOL. Needs help2man, which runs this script as the tool, with --help
# and --version, because it does not know how CLI11 writes names, types and what an option requires.
set -eu
help=$("$1" --help)
case ${2-} in
--version) exec "$1" --version ;;
'')
    name=$(printf '%s\n' "$help" | sed '/^Usage:/,$d' | tr -s '\n' ' ')
    {
        echo '[EXIT STATUS]'
        echo '0: done; 1: failed (input, output, memory); 2: usage error.'
        printf '%s\n' "$help" | sed -n '/^Examples:/,$ { s/\\/\\e/g; s/-/\\-/g; s/^Examples:/[EXAMPLES]\n.nf/; p; }'
        echo '[SEE ALSO]'
        echo 'ldi\-plan(1), ldi\-warp(1), ldi\-cluster(1), dof\-gather(1), dof\-finish(1), dof\-match(1), dof\-compare(1), dof\-view(1)'
    } | help2man --no-info --name "${name% }" --include /dev/stdin "sh '$0' '$1'"
    exit
    ;;
esac
printf '%s\n' "$help" | awk '
    { sub(/^O[Pp][Tt][A-Za-z]*:/, "Options:"); sub(/^P[Oo][Ss][A-Za-z]*:/, "Arguments:") }
    /^Usage:/ { usage = NR }
    /^Examples:/ { exit }
    /^ / && !/^            / { # names and types, and often the text in column 31
        after = substr($0, 29)
        beside = after ~ /^  [^ ]/ || after ~ /^[^ ] [A-Z][^ ]* / && after !~ /REQUIRED|Excludes:|Needs:|Env:|:INT in/
        head = beside ? substr($0, 1, 29) : $0
        sub(/, *--/, ", --", head)
        sub(/ ?:[{][^}]*[}]|:(INT in|SIZE) [[][^]]*[]]/, "", head)
        required = sub(/ REQUIRED/, "", head)
        environment = match(head, /[(]Env:[A-Z_]+/) ? substr(head, RSTART + 5, RLENGTH - 5) : ""
        sub(/ ([(]Env|Needs|Excludes):.*| +$/, "", head)
        count = split(head, word, ",? +")
        $0 = beside ? sprintf("%-28s  %s", head, substr($0, 31)) : head
        if (environment) variables = variables sprintf("  %-28sThe value of %s where the option is not given.\n", environment, word[2])
        if (required && word[2] ~ /^-/) line[usage] = line[usage] " " word[2] " " word[count]
    }
    { line[NR] = $0 }
    END {
        for (i = 1; i in line; ++i) print line[i]
        if (variables) print "\nEnvironment:\n" variables
    }'
