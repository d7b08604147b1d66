// Threads that work on requests: at most `most_at_once`, each created when first needed. The callers of add() limit the
// number of waiting tasks.
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
    void add(std::function<void()> task); // the task must not throw; add() throws if no thread can be created
    void end();                           // waits for all added tasks

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
