// What dof-view answers to what its pages ask. Knows nothing of HTTP.
#pragma once

#include "harness/commands/frames.h"
#include "viewing/asked.h"
#include "viewing/pieces.h"
#include "viewing/shot.h"
#include "viewing/studio.h"
#include "viewing/view_facts.h"
#include "viewing/view_words.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace sparselens {

struct ViewOptions {
    GatherCommand picture;
    std::string reference, save; // a file; a folder; empty: none
    std::string frames;          // read by FrameCommands
    Presets presets = {};
    int port = 0;      // 0: any that is free
    bool open = false; // a browser
};

class Viewer {
public:
    // Reads the files of the first frame. `words` are those of the command line, without the program, and `frames` the same
    // for each frame; `options` are of the first. Throws as dof-gather does.
    Viewer(const ViewOptions &options, const Words &words, const FrameCommands &frames,
           const ToolContext &tool);

    // JSON: what does not change with the lens: size, looks, options, frames.
    std::string facts(const Asked &asked);

    // Each is the length of some JSON (4 bytes, the lowest first), that JSON, and 8-bit pixels by rows; empty where the page
    // has asked for something newer. Throws UsageError where there is no such picture.
    // Of a picture that is asked for with a pixel, tiles are made from there outwards, and may be asked for before it is there.
    std::optional<std::string> picture(const Asked &asked);
    std::string
    pieces(const Asked &asked); // of which the JSON says the places, and the pixels follow each other
    std::optional<std::string> reference(const Asked &asked);
    std::optional<std::string> rendered(const Asked &asked); // without depth of field

    // In that form too, with the two bytes of ObjectMap for each pixel.
    std::string objects(const Asked &asked);

    // JSON: the samples of a pixel, and its value in the last picture; how far the picture of the page is; the commands that
    // make it elsewhere, of a range of frames as words; the name of the PNG that was written (--save).
    std::string samples(const Asked &asked);
    std::string progress(const Asked &asked) const;
    std::string commands(const Asked &asked) const;
    std::optional<std::string> save(const Asked &asked);

private:
    std::size_t frame_of(const Asked &asked) const;
    Words words_of_frame(std::size_t i) const;
    Words words_of(const Asked &asked) const;
    GatherCommand command_of_frame(const Asked &asked) const;
    const Image &reference_of(const std::string &path); // while its mutex is held
    std::shared_ptr<const ShotPicture> taken(const Words &words, const GatherCommand &command,
                                             Progress &progress, const TileWatch *watch = nullptr);
    void add_piece(const Asked &asked, const ShotFrame &frame, const Image &picture,
                   const Imath::Box2i &tile);
    std::string answer(const Words &words, const Asked &asked, Progress &progress);

    ViewOptions options_;
    Words words_; // those that make the pictures, of all frames
    Words guess_; // of the lens, after them
    FrameCommands frames_;
    const ToolContext &tool_;
    Shot shot_;
    struct Reference {
        std::string path;
        Image image;
    };
    std::mutex reference_mutex_;
    std::optional<Reference> reference_; // the last one that was asked for
    // The last picture and what made it, which may be shown in another exposure.
    struct Last {
        Words words;
        int proxy = 1;
        std::shared_ptr<const ShotPicture> picture;
    };
    mutable std::mutex last_mutex_;
    std::optional<Last> last_;
    Pieces pieces_;
    int saved_ = 0;
    Studio studio_; // last: it works with the others
};

} // namespace sparselens
