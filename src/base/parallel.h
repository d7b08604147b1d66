// Loops over independent pieces of work on all the threads the tool was given.
//
// A piece may write only what belongs to it, so a result never depends on the number of threads or on the
// order in which pieces run. Exceptions thrown by a piece end the loop and reach the caller.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace sparselens {

// task(i) for every i in [0, count).
template <typename Task>
void parallel_for(std::size_t count, const Task &task) {
    tbb::parallel_for(std::size_t{0}, count, task);
}

// task(begin, end) over [0, count) cut into runs of at most `grain`; the cuts depend on count and grain alone.
template <typename Task>
void parallel_runs(std::size_t count, std::size_t grain, const Task &task) {
    const std::size_t runs = (count + grain - 1) / grain;
    tbb::parallel_for(std::size_t{0}, runs, [&](std::size_t run) {
        const std::size_t begin = run * grain;
        task(begin, begin + grain < count ? begin + grain : count);
    });
}

} // namespace sparselens
