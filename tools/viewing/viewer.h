// What dof-view answers to what its pages ask. Knows nothing of HTTP.
#pragma once

#include "viewing/asked.h"
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
    Presets presets = {};
    int port = 0;      // 0: any that is free
    bool open = false; // a browser
};

class Viewer {
public:
    // Reads the files. `words` are those of the command line, without the program. Throws as dof-gather does.
    Viewer(const ViewOptions &options, const Words &words, const ToolContext &tool);

    // JSON: what does not change: size, looks, options.
    std::string facts() const;

    // Each is the length of some JSON (4 bytes, the lowest first), that JSON, and 8-bit pixels by rows; empty where the page
    // has asked for something newer. Throws UsageError where there is no such picture.
    std::optional<std::string> picture(const Asked &asked);
    std::optional<std::string> reference(const Asked &asked);
    std::optional<std::string> rendered(const Asked &asked); // without depth of field

    // In that form too, with the two bytes of ObjectMap for each pixel.
    std::string objects() const;

    // JSON: the samples of a pixel, and its value in the last picture; how far the picture of the page is; the commands that
    // make it elsewhere; the name of the PNG that was written (--save).
    std::string samples(const Asked &asked) const;
    std::string progress(const Asked &asked) const;
    std::string commands(const Asked &asked) const;
    std::optional<std::string> save(const Asked &asked);

private:
    Words words_of(const Asked &asked) const;
    std::shared_ptr<const TakenPicture> taken(const Words &words, const GatherCommand &command,
                                              Progress &progress);
    std::string answer(const Words &words, const Asked &asked, Progress &progress);

    ViewOptions options_;
    Words words_; // those that make the picture
    const ToolContext &tool_;
    Shot shot_;
    DepthExtent depths_;
    ObjectNames names_;
    std::optional<Image> reference_;
    // The last picture and what made it, which may be shown in another exposure.
    struct Last {
        Words words;
        int proxy = 1;
        std::shared_ptr<const TakenPicture> picture;
    };
    mutable std::mutex last_mutex_;
    std::optional<Last> last_;
    int saved_ = 0;
    Studio studio_; // last: it works with the others
};

} // namespace sparselens
