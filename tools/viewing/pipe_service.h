// Makes the pictures that dof-view --pipe is asked for. Holds the last LDI, and the last pictures as far as a quarter
// of the memory allows. A picture is made again if one of its files has changed.
#pragma once

#include "base/kept.h"
#include "chain/devices.h"
#include "chain/take_picture.h"
#include "harness/tool.h"
#include "viewing/pipe_request.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace sparselens {

class PipeService {
public:
    explicit PipeService(const ToolContext &tool);

    struct Answer {
        nlohmann::json said;
        std::string pixels; // or the file of a header
    };

    // Takes the pixels of the picture that the request hands over; its source is then a file. Throws UsageError if they are
    // not what it says.
    void take(PipeRequest &request, std::string pixels);

    // Throws as dof-gather does.
    // facts: focus, sharp range, largest CoC and the like (see lens_facts()).
    // header: windows and channels; `pixels` is an EXR file of one pixel, with the header that dof-gather writes.
    // picture, tile: the pixels that dof-gather writes (see stored_pixels()), of the data window or of a box in it.
    Answer answer(const PipeRequest &request);

private:
    // The work of a request, and what it depends on.
    struct Job {
        Words words;
        std::map<std::string, std::string> stamps; // by file; a file that is written again has another
        bool shown = false;                        // see PipeRequest
        GatherCommand command;
        bool operator==(const Job &other) const {
            return words == other.words && stamps == other.stamps && shown == other.shown;
        }
    };
    struct Made {
        TakenPicture picture;
        std::vector<std::string> warnings;
    };

    Job job_of(const PipeRequest &request) const;
    const Made &described(const Job &job);
    const Made &taken(const Job &job);
    using Make = std::function<TakenPicture(const PictureWork &work)>;
    Made make(const Job &job, const Make &make);
    static void to_stored_colours(const Job &job, Image &image, Imf::Header &header);
    Answer facts(const Job &job);
    static Answer header(const Job &job, const Made &made);
    static Answer pixels(const Made &made, const PipeRequest &request);
    static int levels_of(const Job &job, const Made &made);
    void forget_changed(const Job &job);

    const ToolContext &tool_;
    Presets presets_;
    std::map<std::string, std::string> stamps_; // of the files that were read
    LdiCache cache_;
    GatherDevice device_;
    InMemoryPictures handed_;
    static constexpr std::uint64_t most_descriptions = 64;
    Kept<Job, Made> pictures_, descriptions_{most_descriptions};
};

} // namespace sparselens
