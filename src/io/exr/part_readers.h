// A part of scanlines that several threads read at once, each with the file opened for itself: OpenEXR reads, checks
// and copies the rows of one file on one thread, and only decompresses them on several.
#pragma once

#include "base/parallel.h"
#include "io/exr/exr_common.h"
#include "io/files/file_stream.h"

#include <ImfDeepScanLineInputPart.h>
#include <ImfMultiPartInputFile.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace sparselens {

class PartReaders {
public:
    // Readers of part `number` of the file in `stream`. Each reading thread opens the file once.
    PartReaders(const InputStream &stream, int number) : stream_(stream), number_(number) {}

    // Calls work(part) with a reader that no other thread uses.
    template <typename Work>
    auto with_one(const Work &work) {
        std::unique_ptr<Reader> reader = take();
        auto result = work(reader->part);
        const std::lock_guard lock(guard_);
        free_.push_back(std::move(reader));
        return result;
    }

private:
    struct Reader {
        Reader(const InputStream &from, int number)
            : stream(from.another()), file(open_exr(*stream)), part(file, number) {}
        std::unique_ptr<InputStream> stream;
        Imf::MultiPartInputFile file;
        Imf::DeepScanLineInputPart part;
    };
    std::unique_ptr<Reader> take() {
        {
            const std::lock_guard lock(guard_);
            if (!free_.empty()) {
                std::unique_ptr<Reader> reader = std::move(free_.back());
                free_.pop_back();
                return reader;
            }
        }
        return std::make_unique<Reader>(stream_, number_);
    }

    const InputStream &stream_;
    int number_;
    std::mutex guard_; // guards the variables below
    std::vector<std::unique_ptr<Reader>> free_;
};

inline constexpr int rows_at_once = 16; // few, because each thread has memory for this many

// Calls take(make(part, first row, last row)) for all rows of a data window. make() runs on all threads; take() is
// called from the top row down. If several calls throw, the error of the topmost rows is thrown.
template <typename Make, typename Take>
void for_some_rows(const Imath::Box2i &data, PartReaders &readers, const Make &make, const Take &take) {
    const auto rows = [&](std::size_t piece) {
        const int first = data.min.y + int(piece) * rows_at_once,
                  last = std::min(first + rows_at_once - 1, data.max.y);
        return readers.with_one([&](Imf::DeepScanLineInputPart &part) { return make(part, first, last); });
    };
    in_order(std::size_t(pieces_of(data.max.y - data.min.y + 1, rows_at_once)), rows,
             [&](std::size_t, auto made) { take(std::move(made)); });
}

} // namespace sparselens
