// Threads that answer connections: no more than `most_at_once`, each made when it is first needed. Whoever adds a task while
// `most_waiting` wait is held until one is begun, so that memory stays bounded whatever comes.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace sparselens {

class Crew {
public:
    static constexpr std::size_t most_at_once = 64, most_waiting = 128;

    ~Crew() { end(); }
    void add(std::function<void()> task); // it may not throw
    void end();                           // after the tasks that were added

private:
    void run();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> waiting_;
    std::vector<std::thread> threads_;
    std::size_t idle_ = 0;
    bool ending_ = false;
};

} // namespace sparselens
