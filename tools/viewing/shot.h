// The LDIs that are looked at: loaded once, gathered as often as somebody asks.
#pragma once

#include "chain/devices.h"
#include "chain/take_picture.h"
#include "harness/tool.h"
#include "io/display/shown_picture.h"
#include "options/gather_options.h"
#include "viewing/reel.h"

#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace sparselens {

// A picture through a lens: linear R, G, B and A.
struct ShotPicture : TakenPicture {
    DepthExtent depths = {};
    std::vector<std::string> warnings = {};
};

class Shot {
public:
    // Reads the file of the first of these frames, one at least. Throws as dof-gather does.
    Shot(const std::vector<GatherCommand> &frames, const ToolContext &tool);

    // The frame of which a picture is made; by any number of threads. Throws as dof-gather does.
    Reel::Held frame(const GatherCommand &options);
    const Reel &reel() const { return reel_; }

    // What dof-gather would write; by one thread at a time. Throws as that does, and what `progress` throws. Who watches is told of
    // pixels of the picture, where those are what is gathered.
    ShotPicture taken(const GatherCommand &options, const ToolContext &tool, Progress &progress,
                      const TileWatch *watch = nullptr);

    // As PNG shows linear colours of the frame's space, after `exposure` stops.
    static ShownPixels displayed(Image image, double exposure, const ShotFrame &frame);

private:
    // A frame as small as a proxy of it is.
    struct Small {
        std::weak_ptr<const ShotFrame> of; // which is held by the reel alone
        int proxy;
        PackedRows ldi;
        GatherWindows windows;
    };
    GatherWindows small(const Reel::Held &frame, const WindowOptions &options);
    const Ldi *holdout(const GatherCommand &options, const Reel::Held &frame);

    struct ReadHoldout {
        std::string path;
        std::weak_ptr<const ShotFrame> of;
        int proxy;
        Ldi ldi;
    };

    Reel reel_;
    GatherDevice device_;
    std::deque<Small> small_; // the last few
    LooksReader looks_;
    std::deque<ReadHoldout> holdouts_; // the last few
};

} // namespace sparselens
