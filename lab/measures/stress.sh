# The tables of dof-stress: errors and bounds of all extreme cases. 3 minutes.
. "$(dirname "$0")/common.inc" "$1"
dof-stress --markdown
