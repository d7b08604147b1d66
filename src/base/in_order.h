// Pieces that are made on all threads, and taken one by one in their order: a file that is read a few rows at a time.
//
// At most one piece a thread is being made, and no more than that wait to be taken: the pieces never need all their memory at
// once.
#pragma once

#include "base/parallel.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace sparselens {

// Calls take(i, make(i)) for every i in [0, count). make() is called by any thread; take() for 0, 1, 2 ..., by one thread at a
// time. Of what is thrown, that of the least i reaches the caller, whatever the number of threads; nothing is taken after it.
// `most_at_once`, > 0: pieces that are made side by side, however many threads there are.
template <typename Make, typename Take>
void in_order(std::size_t count, const Make &make, const Take &take,
              std::size_t most_at_once = ~std::size_t{0}) {
    using Piece = decltype(make(std::size_t{0}));
    struct Made {
        std::optional<Piece> piece;
        std::exception_ptr failure;
    };
    std::atomic<std::size_t> next = 0;
    std::mutex taking; // of what follows
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
    // A loop in make() or take() would else begin to make other pieces while it waits for its own: both are isolated.
    // The piece that all wait for is being made, as pieces are begun in their order.
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
