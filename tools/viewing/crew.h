// Threads that work on requests: no more than `most_at_once`, each made when it is first needed. How many tasks may wait is a
// matter of those who add them.
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
    static constexpr std::size_t most_at_once = 64;

    ~Crew() { end(); }
    void add(std::function<void()> task); // which may not throw; throws where there can be no thread at all
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
