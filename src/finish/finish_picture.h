// Whole pictures through finish_layer(): R, G and B of the beauty and of each layer together, alpha and other light channels each
// alone; depth, data, ids and Cryptomattes stay as gathered.
#pragma once

#include "base/image.h"
#include "base/progress.h"
#include "finish/error_estimate.h"
#include "finish/lens_check.h"

#include <string>
#include <vector>

namespace sparselens {

// A picture of the same display window as the gathered one; `name` is that of its file, for messages.
struct Render {
    std::string name;
    Image image;
    double samples = 1; // a pixel, > 0
};

// Two or more independent renders through the same lens, added up to two halves of nearly equal numbers of samples. Pixels
// outside a render's data window, and those with a value that is not finite or above 1e8, stay as gathered.
class TwoHalves {
public:
    explicit TwoHalves(const Image &gathered);

    // Throws Error, naming the file, where its display window is not that of the gathered picture.
    void add(const Render &render);
    bool complete() const; // holds two

    std::array<double, 2> samples() const { return samples_; }
    std::size_t missing() const { return missing_; } // pixels that stay as gathered, over all renders
    // Empty where a render lacks the channel. The planes of the caller's channels, for both halves.
    std::array<Values, 2> take(std::size_t channel);
    bool has(std::size_t channel) const { return has_[channel]; }

private:
    Windows windows_;
    std::vector<Channel> channels_;
    std::array<std::vector<Values>, 2>
        sums_; // by channel of the gathered picture; empty: not a channel that is finished
    std::vector<bool> has_;
    std::array<double, 2> samples_{0, 0};
    std::size_t missing_ = 0;
};

struct PictureToFinish {
    Image gathered;
    TwoHalves rays;
    std::vector<TwoHalves> denoised = {}; // what a denoiser made of the same renders, in the same order
    std::vector<Image> others = {};       // further gathered pictures
};

struct FinishedPicture {
    Image image;
    Values kept;                          // of R, G and B: 1 as gathered, 0 as the rays say
    ErrorEstimate error;                  // of R, G and B
    LensMistakes mistakes;                // of R, G and B
    std::vector<std::string> as_gathered; // names of light channels that the renders lack
};

// Throws Error where there are no two halves, or the gathered picture has no R, G and B that all renders have.
FinishedPicture finish_picture(PictureToFinish picture, Progress &progress);

} // namespace sparselens
