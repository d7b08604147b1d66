#!/bin/sh
# Installs the Debian packages that a job needs and this machine lacks.
#
#   tools/install-deps.sh SET...      sets: arm, blender, build, bundle, ci, demo, gpu, lint, python, report, test, windows
#
# Needs only a Debian base system (12 or later), and root or sudo if something is missing. Prints one line if everything
# is installed; otherwise exits with 1 and one line that says why a package is not available.
set -eu

release=$(sed -n 's/^VERSION_CODENAME=//p' "${SPARSELENS_OS_RELEASE-/etc/os-release}" 2>/dev/null || true)
arm='debootstrap g++-aarch64-linux-gnu qemu-user-static'
blender='blender libgl1-mesa-dri xauth xvfb'
build='g++ cmake ninja-build pkg-config libboost-dev libcli11-dev libembree-dev libfmt-dev libimath-dev libjpeg-dev
       libopencolorio-dev libopenexr-dev libopenimageio-dev libpng-dev libtbb-dev nlohmann-json3-dev openimageio-tools'
bundle='help2man xz-utils'
ci=ccache
demo='fonts-dejavu-core openimageio-tools'
gpu='glslc libvulkan-dev mesa-vulkan-drivers spirv-tools vulkan-validationlayers'
lint='clang-14 clang-format-14 clang-tidy-14 libclang-rt-14-dev'
report='chromium chromium-driver python3-matplotlib python3-numpy python3-openimageio'
windows='curl g++-mingw-w64-x86-64-posix libz-mingw-w64-dev wine wine64'
python='pybind11-dev python3-dev'
test="dpkg-dev fakeroot file groff-base help2man libbenchmark-dev libgtest-dev lintian
      munge mypy nodejs openexr $python python3-jsonschema python3-matplotlib python3-numpy python3-openimageio
      python3-pytest python3-venv python3-yaml slurm-client slurmctld slurmd time"
# Differences between releases. The sources are formatted by clang-format 14, which only Debian 12 has; the extensions
# of Blender 5 need modules that its package lacks; the packages for wheels are in Debian 13 and later.
case $release in
bookworm) test="clang-format-14 $test" ;;
trixie) test="$test python3-scikit-build-core" ;;
*)
    blender="$blender python3-cattr python3-requests"
    test="$test python3-scikit-build-core"
    ;;
esac

fail() {
    echo "install-deps: $*" >&2
    exit 1
}

packages_of() {
    for set_name; do
        case $set_name in
        arm) echo $arm ;;
        blender) echo $blender ;;
        build) echo $build ;;
        bundle) echo $bundle ;;
        ci) echo $ci ;;
        demo) echo $demo ;;
        gpu) echo $gpu ;;
        lint)
            [ "$release" = bookworm ] || fail "clang 14, of the set lint, is in Debian 12 alone"
            echo $lint
            ;;
        python) echo $python ;;
        report) echo $report ;;
        test) echo $test ;;
        windows) echo $windows ;;
        *) fail "unknown set '$set_name' (arm, blender, build, bundle, ci, demo, gpu, lint, python, report, test, windows)" ;;
        esac
    done
}

# Packages that are not installed. dpkg-query skips unknown names with a complaint: those are missing too.
missing_of() {
    installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' "$@" 2>/dev/null || true)
    for package; do
        printf '%s\n' "$installed" | grep -qxF "$package installed" || echo "$package"
    done | sort -u
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

# Shows apt's own messages only if it fails. Waits for the lock.
apt_get() {
    as_root env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get -q -y -o DPkg::Lock::Timeout=120 "$@" \
        >>"$log" 2>&1 </dev/null
}

[ $# -gt 0 ] || fail "name at least one set: arm, blender, build, bundle, ci, demo, gpu, lint, python, report, test, windows"
wanted=$(packages_of "$@") || exit 1
if ! command -v dpkg-query >/dev/null; then
    echo "install-deps: not a Debian system, so nothing was checked; needed are: $(echo $wanted)"
    exit 0
fi
missing=$(missing_of $wanted)
if [ -z "$missing" ]; then
    echo "install-deps: nothing is missing ($*)"
    exit 0
fi

missing=$(echo $missing) # on one line
command -v apt-get >/dev/null || fail "apt-get is not there; install these by other means: $missing"
[ "$(id -u)" -eq 0 ] || command -v sudo >/dev/null || fail "neither root nor sudo; as root: apt-get install $missing"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "install-deps: installing $missing"
apt_get update || true # an unrelated broken list must not stop this; install fails if a needed list is broken
apt_get install --no-install-recommends $missing ||
    fail "apt-get could not install $missing: $(grep -E '^(E:|sudo:)' "$log" | tail -n 1)"
