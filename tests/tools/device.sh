#!/bin/bash
# dof-gather --device and ldi-warp --device: the values, machines without a GPU or without Vulkan, and the results of a
# software device.
. "$(dirname "$0")/check.sh"
gather=$bin/dof-gather
unset SPARSELENS_DEVICE

noise() { picture make "$1" 160x90 R=noise:1"$2" G=noise:2"$2" B=noise:3"$2" A=1 Z=8 fill=60x50+"$3"+20 Z=3; } # FILE SEED X
noise input.exr 1 40
lens=(--focal-length 50 --sensor-width 36 --focus-distance 5 --lens-radius 0.25 -d float)
exits 0 "$gather" input.exr "${lens[@]}" -o expected.exr
noise rim.exr 2 42
warp=("$bin/ldi-warp" input.exr --view 0.02,0 rim.exr --focal-length 50 --sensor-width 36 --focus-distance 5)
exits 0 "${warp[@]}" -o expected-ldi.exr

# A loader that cannot be loaded counts as missing.
mkdir broken
for name in libvulkan.so libvulkan.so.1; do echo none >broken/$name; done
without_loader() { LD_LIBRARY_PATH=$PWD/broken exits "$@"; }
without_loader 0 "$bin/dof-gather" --device list
[ "$(cat stdout)" = "Vulkan gives access to no device here" ] || fail "--device list: $(cat stdout)"
for word in cpu auto; do
    without_loader 0 "$gather" input.exr "${lens[@]}" -o out.exr --device $word -v
    grep -qx 'dof-gather: device: the CPU' stderr || fail "--device $word: $(cat stderr)"
    cmp -s out.exr expected.exr || fail "--device $word without a loader gives another picture"
    without_loader 0 "${warp[@]}" -o out.exr --device $word -v
    grep -qx 'ldi-warp: device: the CPU' stderr || fail "ldi-warp --device $word: $(cat stderr)"
    cmp -s out.exr expected-ldi.exr || fail "ldi-warp --device $word without a loader gives other samples"
done
LD_LIBRARY_PATH=$PWD/broken fails_saying 1 'device gpu: no GPU can be used; Vulkan gives access to no device here' \
    "$gather" input.exr "${lens[@]}" -o x.exr --device gpu
LD_LIBRARY_PATH=$PWD/broken fails_saying 1 'device gpu: no GPU can be used; Vulkan gives access to no device here' \
    "${warp[@]}" -o x.exr --device gpu
# -v reports Vulkan's problems: a loader that cannot be loaded, drivers that do not work.
without_loader 1 "$gather" input.exr "${lens[@]}" -o x.exr --device gpu -v
grep -Eq '^dof-gather: Vulkan finds no device: .*load' stderr || fail "a broken loader: $(cat stderr)"
echo '{"file_format_version": "1.0.0", "ICD": {"library_path": "./none.so", "api_version": "1.3.0"}}' >broken/driver.json
VK_DRIVER_FILES=broken/driver.json VK_ICD_FILENAMES=broken/driver.json exits 1 "$gather" input.exr "${lens[@]}" -o x.exr --device gpu -v
grep -Eq '^dof-gather: Vulkan finds no device: .*(Driver|driver)' stderr || fail "a broken driver: $(cat stderr)"
without_loader 0 "$bin/ldi-warp" --device list
[ "$(cat stdout)" = "Vulkan gives access to no device here" ] || fail "ldi-warp --device list: $(cat stdout)"
SPARSELENS_DEVICE=gpu LD_LIBRARY_PATH=$PWD/broken fails_saying 1 'device gpu: no GPU can be used' "$gather" input.exr "${lens[@]}" -o x.exr
# A missing driver gives no device either.
VK_DRIVER_FILES=none.json VK_ICD_FILENAMES=none.json exits 0 "$gather" --device list
[ "$(cat stdout)" = "Vulkan gives access to no device here" ] || fail "--device list without a driver: $(cat stdout)"
! lab || fails_saying 2 '--device no-such.* works with --method lens and --method selective only' "$gather" input.exr "${lens[@]}" -o x.exr --method scatter --device no-such

exits 0 "$gather" --device list
name=$(head -n 1 stdout)
[ "$name" != "Vulkan gives access to no device here" ] || skip "the kernels were not run: $name"
fails_saying 1 "device no-such: no device has that name; there is " "$gather" input.exr "${lens[@]}" -o x.exr --device no-such
name=${name%% (*}
exits 0 "$bin/dof-gather" input.exr "${lens[@]}" -o out.exr --device "$name" -v
grep -q "^dof-gather: device: $name" stderr || fail "--device $name: $(cat stderr)"
grep -qx 'dof-gather: tiles gathered by the device: 6 of 6' stderr || fail "--device $name: $(cat stderr)"
picture same out.exr expected.exr 1e-4 >differ || fail "the device's picture: $(cat differ)"
SPARSELENS_DEVICE=$name exits 0 "$gather" input.exr "${lens[@]}" -o again.exr -v
grep -q "^dof-gather: device: $name" stderr || fail "\$SPARSELENS_DEVICE: $(cat stderr)"
cmp -s again.exr out.exr || fail "the device's picture is another one every time"

# Two frames from one file, with a holdout.
exits 0 "$gather" input.exr "${lens[@]}" -o frame.#.exr --frames 1-2 --device "$name" --holdout input.exr --spherical 0.5 -v
[ "$(grep -c 'gathered by the device: 6 of 6' stderr)" -eq 2 ] || fail "tiles of two frames: $(cat stderr)"
[ "$(grep -o 'uploaded to the device: .* MB' stderr | tail -n 1)" = 'uploaded to the device: 0.0 MB' ] ||
    fail "what does not change is uploaded again: $(cat stderr)"
exits 0 "$gather" input.exr "${lens[@]}" -o expected.exr --holdout input.exr --spherical 0.5
picture same frame.0002.exr expected.exr 1e-4 >differ || fail "a second frame: $(cat differ)"

# The selective gather.
exits 0 "$gather" input.exr "${lens[@]}" -o expected.exr --method selective --layers 3
exits 0 "$gather" input.exr "${lens[@]}" -o out.exr --method selective --layers 3 --device "$name" -v
grep -qx 'dof-gather: tiles gathered by the device: 15 of 15' stderr || fail "--method selective: $(cat stderr)"
picture same out.exr expected.exr 1e-4 >differ || fail "the device's selective picture: $(cat differ)"

# The device's samples equal those of the CPU, in each frame of a range.
fails_saying 1 "device no-such: no device has that name; there is " "${warp[@]}" -o x.exr --device no-such
exits 0 "${warp[@]}" -o out.exr --device "$name" -v
grep -q "^ldi-warp: device: $name" stderr || fail "ldi-warp --device $name: $(cat stderr)"
grep -qx 'ldi-warp: rows warped by the device: 90 of 90' stderr || fail "ldi-warp --device $name: $(cat stderr)"
cmp -s out.exr expected-ldi.exr || fail "ldi-warp: the device's samples are others"
SPARSELENS_DEVICE=$name exits 0 "${warp[@]}" -o ldi.#.exr --frames 1-2 -v
[ "$(grep -c 'warped by the device: 90 of 90' stderr)" -eq 2 ] || fail "rows of two frames: $(cat stderr)"
cmp -s ldi.0002.exr expected-ldi.exr || fail "the samples of a second frame are others"

# dof-view names the device.
exits 0 python3 -c 'import sys; sys.path.insert(0, sys.argv[1]); from served import served
with served(*sys.argv[2:]) as server: print(server.picture(settings={})[0]["device"])' "$source_dir/tests/viewing" "$bin/dof-view" input.exr --device "$name"
grep -q "^$name" stdout || fail "dof-view does not say which device gathered: $(cat stdout)"

# Two processes use one device at once.
"$gather" input.exr "${lens[@]}" -o a.exr --device "$name" --holdout input.exr --spherical 0.5 &
a=$!
"$gather" input.exr "${lens[@]}" -o b.exr --device "$name" --method selective --layers 3 &
b=$!
exits 0 "${warp[@]}" -o out.exr --device "$name"
wait $a && wait $b || fail "two processes on a device: one failed"
cmp -s out.exr expected-ldi.exr || fail "two processes on a device: other samples"
picture same a.exr frame.0002.exr 0 >differ && picture same b.exr expected.exr 1e-4 >differ ||
    fail "two processes on a device: $(cat differ)"

# A device that is lost, or has little memory, costs a line at most.
faulty=$bin/../tests/faulty-vulkan
[ -e "$faulty/libvulkan.so" ] || skip "no Vulkan that fails"
for fault in CALL=60 MB=8; do
    for command in "$gather input.exr ${lens[*]}" "$gather input.exr ${lens[*]} --method selective --layers 3" \
        "${warp[*]}"; do
        exits 0 $command -o expected.exr
        LD_LIBRARY_PATH=$faulty exits 0 env FAULTY_VULKAN_$fault $command -o out.exr --device "$name"
        cmp -s out.exr expected.exr || fail "$fault: another picture: $command $(cat stderr)"
        [ "$(grep -c "$name" stderr)" -eq 1 ] || fail "$fault: $(cat stderr)"
        grep -q 'warning: .* \(was lost\|has not enough memory\); the CPU ' stderr || fail "$fault: $(cat stderr)"
    done
done
