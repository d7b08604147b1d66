# Rules and layouts that the CPU and devices share are defined once, in src/kernels: no shader declares its own
# constant, and nothing in src/gpu repeats a declaration of src/kernels.
#   bash kernels.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

faults=0
fault() {
    echo "FAIL: $1 belongs into src/kernels:" >&2
    sed 's/^/    /' <<<"$2" >&2
    faults=1
}

shaders=$(find src/gpu -name '*.comp' -o -name '*.glsl' | sort)
[ "$(wc -w <<<"$shaders")" -ge 10 ]
# Constants may follow from those that are set when a pipeline is made.
set_late=$(grep -ohE '^layout\(constant_id = [0-9]+\) const uint [a-z]+' $shaders | sed 's/.* //' | paste -sd'|')
if own=$(grep -nE '^(const|#define [a-z_]+ +[0-9.(-])' $shaders | grep -vE "= [^;]*\b($set_late)\b"); then
    fault "a constant of a shader" "$own"
fi

constants=$(grep -ohE 'inline constexpr [a-z]+ [^;]*;' src/kernels/*.h | grep -oE '[a-z_0-9]+ =' | sed 's/ =//' | sort -u)
structs=$(grep -ohE '^struct [A-Za-z]+ \{' src/kernels/*.h | sed 's/struct \(.*\) {/\1/' | sort -u)
[ "$(wc -w <<<"$constants")" -ge 40 ] && [ "$(wc -w <<<"$structs")" -ge 9 ]
declared="const(expr)? [a-z:_0-9]+ ($(paste -sd'|' <<<"$constants"))(\[[^]]*\])? = *[0-9(-]|struct ($(paste -sd'|' <<<"$structs")) \{"
if again=$(grep -rnE "$declared" src/gpu | grep -vE ':[0-9]+: {4,}'); then fault "what stands there already" "$again"; fi
exit $faults
