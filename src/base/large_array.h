// An array that is set by those who fill it: what it grows by is not cleared first, so that its memory is touched by all the threads
// that fill it and not by the one that asks for it. Whoever leaves out an entry finds any value there.
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
