// Answers the requests of dof-view's pages. Independent of HTTP.
#pragma once

#include "base/image.h"
#include "base/kept.h"
#include "harness/commands/frames.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_flat.h"
#include "viewing/job_queue.h"
#include "viewing/page_request.h"
#include "viewing/sequence.h"

#include <Imath/ImathVec.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sparselens {

// A flat picture that pages show besides that of the lens: the last one is kept. Its users take turns, so that it is in
// memory once, however many pages ask.
class LoadedPicture {
public:
    // Returns use(picture). Throws Error if the file cannot be read.
    template <typename Use>
    auto with(const std::string &path, const Use &use) {
        const std::lock_guard lock(mutex_);
        return use(kept_.get(path, [](const std::string &file) { return read_flat_exr(file).image; }));
    }

private:
    std::mutex mutex_;
    Kept<std::string, Image> kept_{1};
};

// Finished tiles of the picture in progress: 8-bit pixels, sent to its page once.
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

struct ViewOptions {
    GatherCommand picture;
    std::string reference, plate, save; // files; a folder; empty: none
    std::string frames;                 // read by FrameCommands
    Presets presets = {};
    int port = 0;      // 0: any free port
    bool open = false; // open a browser
    bool pipe = false; // serve no page (pipe.h)
};

class Viewer {
public:
    // Reads the files of the first frame. `words`: the command line without the program; `frames`: the same for each
    // frame; `options`: of the first frame. Throws as dof-gather does.
    Viewer(const ViewOptions &options, const Words &words, const FrameCommands &frames,
           const ToolContext &tool);

    // JSON: the facts that do not change with the lens: size, looks, options, frames.
    std::string facts(const PageRequest &wanted);

    // Each returns the length of some JSON (4 bytes, the lowest first), that JSON, and 8-bit pixels by rows; empty if
    // the page has asked for something newer. Throws UsageError if there is no such picture. If a pixel is given, tiles
    // are made from there outwards, and pieces() returns them before the picture is complete.
    std::optional<std::string> picture(const PageRequest &wanted);
    std::string
    pieces(const PageRequest &wanted); // the JSON gives their positions; their pixels follow in order
    std::optional<std::string> reference(const PageRequest &wanted);
    std::optional<std::string> plate(const PageRequest &wanted);
    std::optional<std::string> rendered(const PageRequest &wanted); // without depth of field

    // In the same form, with the two bytes of ObjectMap for each pixel.
    std::string objects(const PageRequest &wanted);

    // JSON: the samples of a pixel, and its value in the last picture; the progress of the page's picture; the commands
    // that make it elsewhere, with a range of frames as words; the name of the PNG that was written (--save).
    std::string samples(const PageRequest &wanted);
    std::string progress(const PageRequest &wanted) const;
    std::string commands(const PageRequest &wanted) const;
    std::optional<std::string> save(const PageRequest &wanted);

    // JSON: the lens of the plate, in a region of the picture if one is given; the looks are those of the page.
    std::optional<std::string> match(const PageRequest &wanted);

private:
    std::size_t frame_of(const PageRequest &wanted) const;
    Words words_of_frame(std::size_t i) const;
    Words words_of(const PageRequest &wanted) const;
    GatherCommand command_of_frame(const PageRequest &wanted) const;
    std::string beside(const PageRequest &wanted, const char *option, LoadedPicture &file); // as picture()
    std::string file_of(const PageRequest &wanted, const char *option) const;
    std::shared_ptr<const SequencePicture> taken(const Words &words, const GatherCommand &command,
                                                 Progress &progress, const TileWatch *watch = nullptr);
    void add_piece(const PageRequest &wanted, const LoadedFrame &frame, const Image &picture,
                   const Imath::Box2i &tile);
    std::string answer(const Words &words, const PageRequest &wanted, Progress &progress);

    ViewOptions options_;
    Words words_; // of the pictures, for all frames
    Words guess_; // for the lens, appended to words_
    bool photograph_ = false;
    FrameCommands frames_;
    const ToolContext &tool_;
    Sequence sequence_;
    LoadedPicture reference_, plate_;
    // The last picture and its settings; it can be shown at another exposure.
    struct LastPicture {
        Words words;
        int proxy = 1;
        std::shared_ptr<const SequencePicture> picture;
    };
    mutable std::mutex last_mutex_;
    std::optional<LastPicture> last_;
    Pieces pieces_;
    int saved_ = 0;
    JobQueue queue_; // last: it works with the members above
};

} // namespace sparselens
