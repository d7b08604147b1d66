# The worth of hidden surfaces: lab/hidden.py on three scenes, and on yard if it is there. 15 minutes.
. "$(dirname "$0")/common.inc" "$1"
scenes=(fence grass mist)
[ ! -e "$shared/views/yard" ] || scenes+=("$shared/views/yard")
echo '```'
PYTHONPATH=$bin/../python python3 "$(dirname "$0")/../hidden.py" "${scenes[@]}" --bin "$bin" -o .
echo '```'
