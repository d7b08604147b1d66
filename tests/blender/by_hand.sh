# Presses buttons of the add-on, and makes the same pictures by hand. Sourced in the place of common.sh.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
press() { # FILE.blend VIEWS ACTION...: actions of pictures.py
    local blend=$1 folder=$2
    shift 2
    in_blender "$blend" -P "$source_dir/tests/blender/pictures.py" -- "$(dirname "$views")" "$PWD/$folder" "$@"
}
# by_hand VIEWS FRAME OPTION...: makes hand.exr from the views in this folder; FRAME is like .0001 or empty.
by_hand() {
    local folder=$1 frame=$2
    shift 2
    ldi-warp "$folder/center$frame.exr" "$folder"/view_?"$frame".exr -o hand.ldi.exr 2>log || fail "$(cat log)"
    gathered_by_hand hand.ldi.exr "$@"
}
gathered_by_hand() { # LDI OPTION...
    dof-gather "$1" -o hand.exr --overscan crop "${@:2}" 2>log || fail "$(cat log)"
}
finished_by_hand() { # VIEWS FRAME RAYS_FOLDER OPTION...
    by_hand "$1" "$2" "${@:4}"
    finish_by_hand "$3" "$2"
}
finish_by_hand() { # RAYS_FOLDER FRAME: hand.exr, finished
    mv hand.exr gathered.exr
    dof-finish gathered.exr "$1"/rays_{1,2}"$2".exr -o hand.exr 2>log || fail "$(cat log)"
}
same() { picture same "$1" hand.exr >found 2>&1 || fail "$2 ($(cat found))"; }
