// Finishes whole pictures by finish_layer(): R, G and B of the beauty and of each layer together, alpha and every other
// light channel alone. Light groups, which add up to the beauty, still do. Depth, data, ids and Cryptomattes stay as
// gathered.
#pragma once

#include "base/image.h"
#include "base/progress.h"
#include "finish/error_estimate.h"
#include "finish/finish.h"
#include "finish/lens_check.h"

#include <Imath/half.h>

#include <string>
#include <utility>
#include <vector>

namespace sparselens {

// A picture with the display window of the gathered one; `name` is its file, for messages. A channel `samples` or
// `sampleCount` tells how many samples each pixel has; Cycles' `Debug Sample Count.X` tells which part of `samples`.
struct Render {
    std::string name;
    Image image;
    double samples = 1; // per pixel, > 0
};

// Two or more independent renders through the same lens, added up to two halves: each is added to the half that has
// fewer samples in its pixels. A render may be a part: its display window lies within that of the gathered picture, its
// data window is smaller, or it has zeros in all channels around a rectangle, where the gathered picture has something,
// as a render of a border in Blender. Pixels outside of it, and pixels with a value that is not finite or beyond
// 1e8, are left out. Pixels that a half lacks stay as gathered.
class TwoHalves {
public:
    explicit TwoHalves(const Image &gathered);

    // Throws Error, naming the file, if its display window differs from that of the gathered picture.
    void add(const Render &render);
    // The same for a noisy render. Also throws Error if it has the noise of an earlier one: it is the same render, or
    // has the same seed, so the halves would not tell the noise. Noise unlike that of so many samples adds a doubt.
    void add_noisy(const Render &render);
    const std::vector<std::string> &doubts() const { return doubts_; } // for warnings
    bool complete() const;                                             // whether any pixel has both halves

    RayCounts samples() const;   // pixels that lack a half count as the mean of the others
    std::size_t missing() const; // pixels of the display window that stay as gathered
    // The pixels without light and coverage in the gathered picture and both halves; empty if coverage is not known.
    std::vector<bool> without_light() const;
    // Moves out the planes of a channel of the gathered picture, for both halves; empty if a render lacks it.
    std::array<Values, 2> take(std::size_t channel);
    bool has(std::size_t channel) const { return has_[channel]; }

private:
    struct Noisy {
        std::string name;
        std::vector<half> green;
        double samples;
        Imath::Box2i window;
    };
    Imath::Box2i shown(const Image &image) const; // the pixels that a render shows
    void compare(const Noisy &one, const Noisy &two);
    bool has_both(std::size_t i) const { return counts_[0][i] > 0 && counts_[1][i] > 0; }

    Windows windows_;
    std::vector<Channel> channels_;
    std::vector<half> gathered_green_;
    std::vector<bool> lit_;                   // the pixels in which the gathered picture has something
    std::array<std::vector<Values>, 2> sums_; // by channel of the gathered picture; empty: not finished
    std::vector<bool> has_;
    std::array<Values, 2> counts_; // samples of each pixel
    std::vector<Noisy> noisy_;
    std::vector<std::string> doubts_;
};

// A frame near the one to finish (frames_around.h).
struct FrameAround {
    Image gathered; // with the display window of the frame to finish
    TwoHalves rays; // made with the gathered picture to finish
};

struct PictureToFinish {
    Image gathered;
    TwoHalves rays;
    std::vector<TwoHalves> denoised = {}; // the same renders denoised, in the same order
    std::vector<Image> others = {};       // further gathered pictures
    std::vector<FrameAround> around = {};
};

struct FinishedPicture {
    Image image;
    Values kept;         // for R, G and B: 1 as gathered, 0 as the rays
    ErrorEstimate error; // for R, G and B
    RayCounts samples;
    Imath::Box2i part =
        {}; // the pixels that show anything: outside, nothing is finished, and no error is counted
    std::vector<std::string> warnings;    // mistakes in R, G and B, and doubts about the renders
    std::vector<std::string> as_gathered; // names of light channels that the renders lack
};

// Throws Error if there are not two halves, or the gathered picture lacks R, G and B that all renders have.
FinishedPicture finish_picture(PictureToFinish picture, Progress &progress);

} // namespace sparselens
