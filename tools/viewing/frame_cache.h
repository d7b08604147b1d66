// Holds as many frames of a sequence as fit into memory. Each is read when it is first requested; a thread of its own
// reads the frames after the last requested one ahead. One file is read at a time.
#pragma once

#include "deep/packed_rows.h"
#include "io/display/colour.h"
#include "io/open_ldi.h"
#include "viewing/page_request.h"

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace sparselens {

// One LDI on display, and the facts about it that do not depend on the lens.

// Object id -> name, from the manifests of Cryptomattes in the header.
using ObjectNames = std::map<std::uint32_t, std::string>;
ObjectNames object_names(const Imf::Header &header);

// The range of depths in the picture, in (0, inf]; 1 and 1 if it has no samples. Depths of images count too.
struct DepthExtent {
    double nearest = 1, farthest = 1;
};
DepthExtent depth_extent(const Ldi &ldi);

Ldi all_rows(const PackedRows &rows);

// An LDI in half the memory.
struct LoadedFrame {
    OpenedLdi in;      // the file without its samples
    PackedRows packed; // the samples
    int across = 1;    // sub-pixels of the LDI that become one pixel
    DepthExtent depths = {};
    ObjectNames names = {};
    ColourTransform to_display = {}; // from the file's colours to those of a PNG

    Ldi row(int y) const; // of the data window
    OpenedLdi unpacked() const;

    // The camera and the lens of the picture. Throws as dof-gather does.
    Camera camera(const PictureRequest &request) const;
    ThinLens lens(const PictureRequest &request) const; // for pixels of the picture
};

LoadedFrame pack(OpenedLdi in); // sets only `in` and `packed`

// Throws Error if the file has no R, G and B, which the page shows.
LoadedFrame loaded_frame(OpenedLdi in, const WindowOptions &windows, const ColourOptions &colour);

// An initial lens if neither the file nor the command line gives one; the page is there to choose another. Options of
// dof-gather for what is unknown: 50 mm before a sensor 36 mm wide, f/2.8, focused on the middle of the picture. Empty
// if all is known.
Words lens_guess(const LoadedFrame &frame, const Camera &camera);

// The same in words for people; empty for no options.
std::string guess_in_words(const Words &guess);

class FrameCache {
public:
    using Held = std::shared_ptr<const LoadedFrame>;
    using Read = std::function<LoadedFrame(const std::string &path)>; // may throw

    // `paths`: the files in order; several frames may share a file. The held frames take at most `most_bytes`, except
    // that the last requested one is always held.
    FrameCache(const std::vector<std::string> &paths, std::uint64_t most_bytes, Read read);
    ~FrameCache(); // waits for the current read
    FrameCache(const FrameCache &) = delete;
    FrameCache &operator=(const FrameCache &) = delete;

    // Returns the frame of the file; reads it if it is not held, and throws that read's errors. Any number of threads
    // may call it.
    Held at(const std::string &path);

    std::size_t held() const; // number of files
    bool holds(const std::string &path) const;

private:
    std::size_t number_of(const std::string &path) const;
    std::size_t ahead(std::size_t number) const;
    std::optional<std::size_t> next_ahead() const;
    void make_room(std::uint64_t bytes);
    Held read(std::unique_lock<std::mutex> &lock, std::size_t number);
    void read_ahead();

    std::vector<std::string> paths_; // each once
    std::uint64_t most_bytes_;
    Read read_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::size_t, Held> held_; // by the file's number
    std::vector<bool> bad_;            // files that could not be read ahead
    std::size_t last_asked_ = 0;
    std::uint64_t held_bytes_ = 0, largest_ = 0; // largest: of all frames so far
    bool forwards_ = true, reading_ = false, closing_ = false;
    std::thread reader_; // last: it uses the members above; none for a single file
};

} // namespace sparselens
