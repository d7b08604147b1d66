#!/bin/bash
# The test suite under sanitizers.
#
#   tests/sanitizers.sh [--units | --quick] [asan] [tsan]   asan: Address- and UndefinedBehaviorSanitizer, with assertions;
#                                                           tsan: ThreadSanitizer; both
#
# Builds in build-clang/ (clang 14) and build-tsan/. Leaves out tests of the sources and of the package, which run
# nothing for sanitizers to check, and the demo. --units: the unit tests alone. --quick, which continuous integration
# runs: the unit tests without devices and without the slowest, which repeat on large pictures what others do on small
# ones, and the scripts that give tools odd windows, layers and files.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

export ASAN_OPTIONS=detect_leaks=1:abort_on_error=1:allocator_may_return_null=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export TSAN_OPTIONS="halt_on_error=1:second_deadlock_stack=1:suppressions=$PWD/tests/tsan.suppressions"
export LSAN_OPTIONS="suppressions=$PWD/tests/lsan.suppressions:print_suppressions=0"
export SPARSELENS_HOSTILE_SECONDS=400 SPARSELENS_HOSTILE_KB=4000000 # sanitizers need more time and memory

# These tests take more than a second each without sanitizers, and two thirds of the total time.
slowest='Cells.ThePictureIsThatOfManyLensPointsWhateverTheLensAndTheSamplesAre
FrameExtension.ElementsThatTheFrameCutsOffStayOpaque
FrameExtension.TheSkyBesideABarThatLeavesIsNoDarkerThere
GatherRows.BlurFarWiderThanTheCellsAroundIsTheSame
Invariants.AMirroredPictureIsMirrored
Invariants.FourTimesTheLensPointsAreCloserToTheTruth
LampLight.IsKeptBeforeA*
LensGather.SubpixelsLookFromNearTheirMiddle
LensGatherOfAPoint.BehindAPostShinesByItsShareInSmallStepsOfFocusAndAperture
LensLooks.ChangeThePicture
LensLooks.GiveTheSameBitsOnAnyNumberOfThreads
LensSearch.finds_the_focus_and_the_lens_of_a_graded_plate
LensSearch.noise_widens_the_spread
LensSearch.tells_softness_of_the_whole_from_the_lens
ShapeSearch.TellsS*'

targets=() tests=(-E '^(scripts|packaging|bench)\.')
case ${1-} in
--units)
    shift
    targets=(--target sparselens-tests sparselens-lab-tests) tests=(-R '^(lab\.)?unit\.')
    ;;
--quick)
    shift
    # The last three have generated sources, which tests/clang.sh --rest cannot read before they are made.
    targets=(--target sparselens-tests sparselens-pictures dof-accumulate dof-trace ldi-plan ldi-warp ldi-cluster dof-gather
        dof-finish dof-compare dof-view sparselens_ofx sparselens_python)
    tests=(-R '^(unit\.|fixture\.|tools\.(bad-pixels|denoised|hostile|ldi-warp|layers|windows)$)')
    export GTEST_FILTER="-*Device*.*:$(paste -sd : <<<"$slowest")"
    ;;
esac
[ $# -gt 0 ] || set -- asan tsan
for sanitizer; do
    preset=${sanitizer/asan/clang}
    [ "$preset" != clang ] || tools/install-deps.sh build test lint
    cmake --preset "$preset" --log-level=WARNING
    cmake --build "build-$preset" -j "$(nproc)" "${targets[@]}"
    ctest --test-dir "build-$preset" --output-on-failure --timeout 10000 -j 2 "${tests[@]}"
done
