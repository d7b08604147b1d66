// Loops over independent pieces of work, on all the threads that the tool was given.
//
// A piece may write only what belongs to it, so the result never depends on the number of threads or on the order in
// which the pieces run. An exception thrown by a piece ends the loop and reaches the caller. A loop within a piece has
// a context of its own: when another piece of the outer loop throws, the inner loop still finishes, so that no code
// continues with an incomplete result.
#pragma once

#include "base/grid.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <cstddef>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace sparselens {

// A happens-before edge that ThreadSanitizer cannot see, because TBB is not instrumented.
class Moment {
public:
#ifdef __SANITIZE_THREAD__
    void reached() { __tsan_release(this); }
    void passed() { __tsan_acquire(this); }
#else
    void reached() {}
    void passed() {}
#endif
};

// Calls task(i) for every i in [0, count).
template <typename Task>
void parallel_for(std::size_t count, const Task &task) {
    tbb::task_group_context own(tbb::task_group_context::isolated);
    Moment begun, done;
    begun.reached();
    // The captured variables were written before the loop began, which ThreadSanitizer knows only after passed().
    const auto piece = [&](std::size_t i) __attribute__((no_sanitize("thread"))) {
        begun.passed();
        task(i);
        done.reached();
    };
    tbb::parallel_for(std::size_t{0}, count, piece, own);
    done.passed();
}

// Calls task(begin, end) for ranges of at most `grain` that make up [0, count) and depend on count and grain alone.
template <typename Task>
void parallel_ranges(std::size_t count, std::size_t grain, const Task &task) {
    parallel_for(pieces_of(count, grain), [&](std::size_t run) {
        const std::size_t begin = run * grain;
        task(begin, begin + grain < count ? begin + grain : count);
    });
}

} // namespace sparselens
