# Completion for bash: the options of the tools, and the words of which an option takes one, from --help.
_sparselens() {
    local line names=() words=
    while IFS= read -r line; do
        [[ $line =~ ^\ +(-[^ ,]+)(, *(-[^ ,]+))?( ([^ :]+\|[^ :]*))? ]] || continue
        names+=("${BASH_REMATCH[1]}" "${BASH_REMATCH[3]}")
        [[ -z $3 || " ${names[*]: -2} " != *" $3 "* ]] || words=${BASH_REMATCH[5]//|/ }
    done < <("$1" --help 2>/dev/null)
    [ -n "$words" ] || [[ $2 != -* ]] || words=${names[*]}
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$2")
}
complete -o bashdefault -o default -F _sparselens dof-{accumulate,compare,finish,gather,match,report,trace,view} ldi-{cluster,plan,warp}
