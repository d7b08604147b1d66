// The frames of a command line, one after the other. How each ends may run aside: beside the job of the next one, no more than
// one at a time. Nothing of a frame is written before all is well with those before.
#pragma once

#include <algorithm>
#include <functional>
#include <future>

namespace sparselens {

class FrameRun {
public:
    explicit FrameRun(bool skip_bad_frames) : skip_bad_frames_(skip_bad_frames) {}

    // Whether to go on with the next frame. `job` works on one, and `finish` ends it, where the job succeeded; both return
    // exit codes.
    bool go_on(const std::function<int()> &job, const std::function<int()> &finish, bool aside) {
        const int code = job();
        const bool well_before = !finishing_.valid() || is_well(finishing_.get());
        if (!is_well(code) || !well_before) return false;
        if (code != 0) return true;
        if (!aside) return is_well(finish());
        finishing_ =
            std::async(std::launch::async | std::launch::deferred, finish); // at once, if a thread can be had
        return true;
    }

    // The largest exit code of all; what runs aside has ended.
    int worst() {
        if (finishing_.valid()) is_well(finishing_.get());
        return worst_;
    }

private:
    bool is_well(int code) {
        worst_ = std::max(worst_, code);
        return code == 0 || (code == 1 && skip_bad_frames_);
    }

    bool skip_bad_frames_;
    int worst_ = 0;
    std::future<int> finishing_;
};

} // namespace sparselens
