// Shared by calls of src/chain: the devices of the keyword `device`, which live until the interpreter ends, and the
// conversion of warnings into Python's (UserWarning) when the work is done.
#pragma once

#include "chain/devices.h"
#include "chain/words.h"
#include "python/job.h"
#include "python/objects.h"

namespace sparselens::python {

// Runs work(progress, tell) as a job().
template <typename Result>
Result told_job(const py::object &callback, const std::function<Result(Progress &, const Tell &)> &work) {
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
