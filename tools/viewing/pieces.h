// Finished tiles of the picture in progress: 8-bit pixels, sent to its page once.
#pragma once

#include "io/display/shown_picture.h"

#include <Imath/ImathVec.h>

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace sparselens {

struct Piece {
    Imath::V2i first; // top left pixel, EXR coordinates
    ShownPixels pixels;
};

// Pieces of one picture at a time. Any number of threads may add and take them.
class Pieces {
public:
    // During its lifetime a picture of the page is in progress, at first without pieces.
    class AtWork {
    public:
        AtWork(Pieces &pieces, const std::string &page) : pieces_(pieces) { pieces_.begin(page); }
        ~AtWork() { pieces_.begin(""); }
        AtWork(const AtWork &) = delete;
        AtWork &operator=(const AtWork &) = delete;

    private:
        Pieces &pieces_;
    };

    void add(Piece piece) {
        const std::lock_guard lock(mutex_);
        pieces_.push_back(std::move(piece));
    }
    // Takes the new pieces, in order; none if another page's picture is in progress.
    std::vector<Piece> take(const std::string &page) {
        const std::lock_guard lock(mutex_);
        if (page != page_) return {};
        return std::exchange(pieces_, {});
    }

private:
    void begin(const std::string &page) {
        const std::lock_guard lock(mutex_);
        page_ = page;
        pieces_ = {};
    }

    std::mutex mutex_;
    std::string page_;
    std::vector<Piece> pieces_;
};

} // namespace sparselens
