# Sourced by the scripts that try programs for Windows, after check.sh.
#
# windows_programs BIN: each program NAME.exe in this folder can be called as NAME, by wine with a new prefix in the scratch
# folder.
windows_programs() {
    export WINEPREFIX=$scratch/wine WINEDEBUG=-all WINEDLLOVERRIDES=mscoree,mshtml=
    local program
    for program in "$1"/*.exe; do
        [ -e "$program" ] || continue
        command -v wine >/dev/null || fail "wine is not there: tools/install-deps.sh windows"
        printf '#!/bin/sh\nexec wine "%s" "$@"\n' "$program" >"${program%.exe}"
        chmod +x "${program%.exe}"
    done
}
