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
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

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

// Returns what the vectors find(0), find(1), find(2) ... hold, in this order. Any thread may call find().
template <typename Find>
auto joined(std::size_t count, const Find &find) {
    std::vector<decltype(find(std::size_t{0}))> found(count);
    parallel_for(count, [&](std::size_t i) { found[i] = find(i); });
    std::size_t total = 0;
    for (const auto &some : found) total += some.size();
    decltype(find(std::size_t{0})) all;
    all.reserve(total);
    for (std::size_t i = 0; i < count; ++i) {
        std::ranges::move(found[i], std::back_inserter(all));
        found[i] = {}; // its memory is not needed any more
    }
    return all;
}

// Makes pieces on all threads, and takes them one by one in their order, for example a file that is read a few rows at
// a time.
//
// Each thread makes at most one piece at a time. The pieces that are made or wait to be taken are at most twice as
// many as the threads, so the pieces never need all their memory at once.

// Calls take(i, make(i)) for every i in [0, count). Any thread may call make(). take() is called for 0, 1, 2 ..., by
// one thread at a time. If calls throw, the caller gets the exception of the least i, whatever the number of threads,
// and no later piece is taken. `most_at_once` (> 0) limits the pieces that are made side by side, however many threads
// there are.
template <typename Make, typename Take>
void in_order(std::size_t count, const Make &make, const Take &take,
              std::size_t most_at_once = ~std::size_t{0}) {
    using Piece = decltype(make(std::size_t{0}));
    struct Made {
        std::optional<Piece> piece;
        std::exception_ptr failure;
    };
    std::atomic<std::size_t> next = 0;
    std::mutex taking; // guards the variables below
    std::condition_variable moved;
    std::map<std::size_t, Made> waiting;
    std::size_t taken = 0;
    std::exception_ptr failure;
    const auto take_in_order = [&](std::size_t i, Made made) {
        const std::lock_guard lock(taking);
        waiting.emplace(i, std::move(made));
        for (auto first = waiting.begin(); !failure && first != waiting.end() && first->first == taken;
             first = waiting.erase(first), ++taken)
            try {
                if (first->second.failure) std::rethrow_exception(first->second.failure);
                tbb::this_task_arena::isolate([&] { take(taken, std::move(*first->second.piece)); });
            } catch (...) {
                failure = std::current_exception();
                next = count;
            }
        moved.notify_all();
    };
    const std::size_t threads = std::min(std::size_t(tbb::this_task_arena::max_concurrency()), most_at_once);
    // make() and take() run isolated; otherwise a loop in them would begin to make other pieces while it waits for its
    // own. Waiting cannot deadlock: pieces begin in their order, so the piece that all wait for is being made.
    const auto wait_for_turn = [&](std::size_t i) {
        std::unique_lock lock(taking);
        moved.wait(lock, [&] { return i < taken + 2 * threads || failure; });
    };
    parallel_for(threads < count ? threads : count, [&](std::size_t) {
        for (std::size_t i = next++; i < count; i = next++) {
            wait_for_turn(i);
            Made made;
            try {
                tbb::this_task_arena::isolate([&] { made.piece.emplace(make(i)); });
            } catch (...) {
                made.failure = std::current_exception();
            }
            take_in_order(i, std::move(made));
        }
    });
    if (failure) std::rethrow_exception(failure);
}

} // namespace sparselens

// Compiles loops over all pixels for several processors of x86-64. No version contracts products and sums, so all give the
// same bits. It is off in Windows, whose loader cannot choose among them, and under ThreadSanitizer, because the loader
// chooses before ThreadSanitizer has started.

#if defined(__SANITIZE_THREAD__) || !defined(__x86_64__) || defined(_WIN32)
#define FOR_PROCESSORS
#else
#define FOR_PROCESSORS [[gnu::target_clones("default,avx2")]]
#endif
