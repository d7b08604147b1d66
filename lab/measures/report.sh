# dof-report's tables of three scenes, and of yard where it is there. 25 minutes.
. "$(dirname "$0")/common.inc" "$1"
scenes=(fence grass lamps)
[ ! -e "$shared/views/yard" ] || scenes+=("$shared/views/yard")
echo '```'
dof-report "${scenes[@]}" -o report
echo '```'
