// Long work that Python asked for: it runs without the interpreter's lock, reports its progress and can be interrupted.
//
// The work runs on a thread of its own. The calling thread waits for it without the lock, wakes to call the progress
// callback and to look for signals, and so answers Ctrl-C within a twentieth of a second, whatever the work is doing.
#pragma once

#include "base/progress.h"
#include "chain/devices.h"
#include "chain/notices.h"
#include "python/objects.h"

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>

namespace sparselens::python {

namespace py = pybind11;

// Runs `work`; the lock is held before and after. `callback` is None or is called with the name of the stage and a
// whole percentage, which ascends within a stage. Rethrows what the work throws. If the callback raises, or a signal
// does (KeyboardInterrupt), the work ends at its next percent or step, and that exception is thrown. Throws TypeError
// if the callback cannot be called.
void run_job(const py::object &callback, const std::function<void(Progress &)> &work);

// The same for work that gives a result.
template <typename Result>
Result job(const py::object &callback, const std::function<Result(Progress &)> &work) {
    std::optional<Result> result;
    run_job(callback, [&](Progress &progress) { result.emplace(work(progress)); });
    return std::move(*result);
}

// Shared by calls of src/chain: the devices of the keyword `device`, which live until the interpreter ends, and the
// conversion of warnings into Python's (UserWarning) when the work is done.

// Runs work(progress, tell) as a job().
template <typename Result>
Result job_with_notices(const py::object &callback,
                        const std::function<Result(Progress &, const Notify &)> &work) {
    std::vector<std::string> warnings;
    Result result = job<Result>(callback, [&](Progress &progress) {
        return work(progress, [&](const Notice &notice) {
            if (level_of(notice) != NoticeLevel::note) warnings.push_back(words_of(notice));
        });
    });
    for (const std::string &warning : warnings) warn(warning);
    return result;
}

inline GatherDevice &gather_device() {
    static GatherDevice one;
    return one;
}
inline WarpingDevice &warp_device() {
    static WarpingDevice one;
    return one;
}

} // namespace sparselens::python
