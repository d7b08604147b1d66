// The LDIs that a page shows: read once, gathered for every request.
#pragma once

#include "base/kept.h"
#include "chain/devices.h"
#include "chain/take_picture.h"
#include "harness/tool.h"
#include "io/display/shown_picture.h"
#include "options/gather_options.h"
#include "viewing/frame_cache.h"
#include "viewing/page_request.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sparselens {

// A picture through a lens: linear R, G, B and A.
struct SequencePicture : TakenPicture {
    DepthExtent depths = {};
    std::string device = {}; // that gathered it; empty: the CPU
    std::vector<std::string> warnings = {};
};

class Sequence {
public:
    // Reads the file of the first of these frames (at least one). Throws as dof-gather does.
    Sequence(const std::vector<GatherCommand> &frames, const ToolContext &tool);

    // The frame that a picture is made of. Any number of threads may call it. Throws as dof-gather does.
    FrameCache::Held frame(const GatherCommand &options);
    const FrameCache &frames() const { return frames_; }

    // The picture that dof-gather would write; of the moments of a shutter, a proxy shows the middle one. One thread at a
    // time. Throws as dof-gather does, and what `progress`
    // throws. `watch` is told of the picture's pixels only if these are gathered directly.
    SequencePicture taken(const GatherCommand &options, const ToolContext &tool, Progress &progress,
                          const TileWatch *watch = nullptr);

    // Converts linear colours of the frame's space for PNG, after `exposure` stops.
    static ShownPixels displayed(Image image, double exposure, const LoadedFrame &frame);

private:
    GatherWindows small(const FrameCache::Held &frame, const WindowOptions &options);
    const Ldi *holdout(const GatherCommand &options, const FrameCache::Held &frame);

    struct OfFrame {
        std::weak_ptr<const LoadedFrame> frame; // only the cache owns it
        int proxy;
        std::string holdout = {};
        bool operator==(const OfFrame &other) const {
            return frame.lock() == other.frame.lock() && proxy == other.proxy && holdout == other.holdout;
        }
    };
    // A frame reduced to the size of a proxy.
    struct CachedProxy {
        PackedRows ldi;
        GatherWindows windows;
    };
    // How many proxies or holdouts are kept: a page settles on one, and tries others on the way to it.
    static constexpr std::uint64_t most_small = 2;

    FrameCache frames_;
    GatherDevice device_;
    LooksReader looks_;
    Kept<OfFrame, CachedProxy> small_{most_small};
    Kept<OfFrame, Ldi> holdouts_{most_small};
};

// Facts that a page shows beside the picture: about the lens, and the samples of a pixel. As JSON, with infinity as
// "inf".

// Focus, f-number, sharp range (a CoC of at most a pixel), hyperfocal distance, the largest CoC, warnings.
nlohmann::json lens_facts(const SequencePicture &picture);

// The controls of the looks of the lens, from the table of parameters: a choice of words, a number or a pair; which of
// them can be keyed by frame.
nlohmann::json look_controls(const Presets &lenses);

// The samples of a pixel of the picture (of its middle sub-pixel), front to back: depth, CoC, alpha, colour, objects.
nlohmann::json sample_facts(const LoadedFrame &frame, const ThinLens &lens, const Imath::V2i &pixel);

// The frontmost objects in the pixels of the picture. `said`: for each object its name, and focus and hyperfocal
// distance of the widest lens for which all of it is sharp. `numbers`: two bytes for each pixel, the lower first: the
// object's number, from 1 to 65535; 0: no object, or one beyond 65535.
struct ObjectMap {
    nlohmann::json said;
    std::vector<std::uint8_t> numbers;
};
ObjectMap object_map(const LoadedFrame &frame);

} // namespace sparselens
