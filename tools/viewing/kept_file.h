// A flat picture that pages show besides that of the lens: the last one is kept. Its users take turns, so that it is in
// memory once, however many pages ask.
#pragma once

#include "base/image.h"
#include "io/exr/exr_flat.h"

#include <mutex>
#include <string>
#include <utility>

namespace sparselens {

class KeptFile {
public:
    // Returns use(picture). Throws Error if the file cannot be read.
    template <typename Use>
    auto with(const std::string &path, const Use &use) {
        const std::lock_guard lock(mutex_);
        if (path_ != path) {
            path_.clear();
            image_ = read_flat_exr(path).image;
            path_ = path;
        }
        return use(std::as_const(image_));
    }

private:
    std::mutex mutex_;
    std::string path_; // empty: none
    Image image_;
};

} // namespace sparselens
