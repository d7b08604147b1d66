// A std::vector that does not clear what it grows by: whoever asks for entries sets all of them, and one that is not set may hold
// anything. The threads that set them are then the first to touch their memory, which takes as long as clearing does; a std::vector
// has it touched by one thread.
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
