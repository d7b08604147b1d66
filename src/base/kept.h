// The last used of values that take time to make, by their keys.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <list>
#include <utility>

namespace sparselens {

// Keeps values that weigh at most `most` together, but always the last used one; each weighs 1 unless `weigh` says
// otherwise. One thread at a time may use it. A value stays in its place until it is dropped.
template <typename Key, typename Value>
class Kept {
public:
    explicit Kept(
        std::uint64_t most,
        std::uint64_t (*weigh)(const Value &) = [](const Value &) { return std::uint64_t{1}; })
        : most_(most), weigh_(weigh) {}

    // Returns the value of the key. If none is kept, drops the values that were used least recently, so that a new one
    // fits, and makes it by make(key). If make() throws, nothing is kept for the key.
    template <typename Make>
    Value &get(Key key, const Make &make) {
        const auto found = std::ranges::find(entries_, key, &Entry::first);
        if (found != entries_.end()) {
            entries_.splice(entries_.begin(), entries_, found);
        } else {
            drop_beyond(1, entries_.begin());
            entries_.emplace_front(std::move(key), make(std::as_const(key)));
            drop_beyond(weigh_(entries_.front().second), std::next(entries_.begin()));
        }
        return entries_.front().second;
    }

    // Drops the values for which is(key, value) is true.
    template <typename Is>
    void drop_if(const Is &is) {
        std::erase_if(entries_, [&](const Entry &entry) { return is(entry.first, entry.second); });
    }

private:
    using Entry = std::pair<Key, Value>;

    // Drops all from the first entry that no longer fits beside `weight`.
    void drop_beyond(std::uint64_t weight, typename std::list<Entry>::iterator entry) {
        while (entry != entries_.end() && (weight += weigh_(entry->second)) <= most_) ++entry;
        entries_.erase(entry, entries_.end());
    }

    std::uint64_t most_;
    std::uint64_t (*weigh_)(const Value &);
    std::list<Entry> entries_; // the last used first
};

} // namespace sparselens
