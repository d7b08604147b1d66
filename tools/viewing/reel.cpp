#include "viewing/reel.h"

#include <algorithm>
#include <exception>
#include <set>
#include <utility>

namespace sparselens {

Reel::Reel(const std::vector<std::string> &paths, std::uint64_t most_bytes, Read read)
    : most_bytes_(most_bytes), read_(std::move(read)) {
    std::set<std::string> seen;
    for (const std::string &path : paths)
        if (seen.insert(path).second) paths_.push_back(path);
    bad_.resize(paths_.size());
    if (paths_.size() > 1) reader_ = std::thread([this] { read_ahead(); });
}

Reel::~Reel() {
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
        changed_.notify_all();
    }
    if (reader_.joinable()) reader_.join();
}

std::size_t Reel::number_of(const std::string &path) const {
    return std::size_t(std::ranges::find(paths_, path) - paths_.begin());
}

// The number of steps from the last requested frame, in the direction of the requests, wrapping at the end.
std::size_t Reel::ahead(std::size_t number) const {
    const std::size_t count = paths_.size();
    return (forwards_ ? number + count - last_asked_ : last_asked_ + count - number) % count;
}

Reel::Held Reel::at(const std::string &path) {
    const std::size_t number = number_of(path);
    std::unique_lock lock(mutex_);
    if (number != last_asked_) {
        forwards_ = true;
        forwards_ = ahead(number) <= paths_.size() / 2; // the shorter way
        last_asked_ = number;
        changed_.notify_all();
    }
    changed_.wait(lock, [&] { return held_.contains(number) || !reading_; });
    const auto found = held_.find(number);
    return found != held_.end() ? found->second : read(lock, number);
}

std::size_t Reel::held() const {
    const std::lock_guard lock(mutex_);
    return held_.size();
}

bool Reel::holds(const std::string &path) const {
    const std::lock_guard lock(mutex_);
    return held_.contains(number_of(path));
}

// Frees the farthest frames until `bytes` more fit, but never the last requested one.
void Reel::make_room(std::uint64_t bytes) {
    while (held_bytes_ + bytes > most_bytes_) {
        const auto farthest =
            std::ranges::max_element(held_, {}, [this](const auto &frame) { return ahead(frame.first); });
        if (farthest == held_.end() || farthest->first == last_asked_) return;
        held_bytes_ -= farthest->second->packed.bytes();
        held_.erase(farthest);
    }
}

// Reads a frame; no other thread reads meanwhile.
Reel::Held Reel::read(std::unique_lock<std::mutex> &lock, std::size_t number) {
    reading_ = true;
    make_room(largest_);
    lock.unlock();
    Held frame;
    std::exception_ptr failure;
    try {
        frame = std::make_shared<const ShotFrame>(read_(paths_.at(number)));
    } catch (...) {
        failure = std::current_exception();
    }
    lock.lock();
    reading_ = false;
    changed_.notify_all();
    if (failure) std::rethrow_exception(failure);
    bad_[number] = false;
    held_[number] = frame;
    held_bytes_ += frame->packed.bytes();
    largest_ = std::max(largest_, frame->packed.bytes());
    make_room(0);
    return frame;
}

// The nearest frame that is not held, if it fits beside the nearer ones.
std::optional<std::size_t> Reel::next_ahead() const {
    std::uint64_t nearer = 0;
    for (std::size_t step = 0; step < paths_.size(); ++step) {
        const std::size_t count = paths_.size(),
                          number = (forwards_ ? last_asked_ + step : last_asked_ + count - step) % count;
        const auto found = held_.find(number);
        if (found != held_.end())
            nearer += found->second->packed.bytes();
        else if (step == 0)
            return {}; // at() reads it
        else if (!bad_[number])
            return nearer + largest_ <= most_bytes_ ? std::optional(number) : std::nullopt;
    }
    return {};
}

void Reel::read_ahead() {
    std::unique_lock lock(mutex_);
    for (;;) {
        std::optional<std::size_t> next;
        changed_.wait(lock, [&] {
            if (!reading_ && !closing_) next = next_ahead();
            return closing_ || next;
        });
        if (closing_) return;
        try {
            read(lock, *next);
        } catch (...) {
            bad_[*next] = true; // at() tries again and reports the error
        }
    }
}

} // namespace sparselens
