// A std::vector that does not clear new entries. The caller must set all of them; an entry that is not set may hold
// anything. First touching the memory takes as long as clearing it, and here the threads that set the entries share
// that work.
#pragma once

#include <memory>
#include <utility>
#include <vector>

namespace sparselens {

template <typename T>
struct LeftUnset : std::allocator<T> {
    template <typename U>
    struct rebind {
        using other = LeftUnset<U>;
    };
    using std::allocator<T>::allocator;
    template <typename U>
    void construct(U *at) {
        ::new (static_cast<void *>(at)) U;
    }
    template <typename U, typename... Values>
    void construct(U *at, Values &&...values) {
        std::construct_at(at, std::forward<Values>(values)...);
    }
};

template <typename T>
using LargeArray = std::vector<T, LeftUnset<T>>;

} // namespace sparselens
