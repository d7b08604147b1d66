// The samples of a view: one in each pixel that shows something (A is not 0, depth is above 0). Other samples may
// replace it. Unchanged samples use the memory of the view, because five views are most of the warp's memory. A deep
// view has the samples of its file: a pixel with several samples, or with a volume, holds parts; every other pixel
// holds one sample, as in a flat view.
#pragma once

#include "base/image.h"
#include "deep/build.h"
#include "view/lens_views.h"
#include "view/view.h"

#include <bit>
#include <compare>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

class ViewSamples {
public:
    // Takes the channels of these names, in this order. It refers to the view, which must outlive it. Throws Error,
    // naming the view, if a channel is missing.
    ViewSamples(const View &view, std::span<const Channel> channels);
    // Takes the pixels of the view and packs them.
    ViewSamples(View &&view, std::span<const Channel> channels);
    // Takes a deep view; `samples` must be tidy and in the middle of their pixels. The weight of a part is the share of
    // light that the parts before it let through, because that share of the renderer's samples hit it, but not less
    // than the weight of an estimate (WarpTuning::estimate_weight).
    explicit ViewSamples(Ldi &&samples);
    ViewSamples(ViewSamples &&) = default;
    ViewSamples &operator=(ViewSamples &&) = default;

    Windows windows;
    std::vector<Channel> channels;

    std::size_t alpha() const { return find_channel(channels, "A"); } // npos: all samples opaque

    // The samples of a pixel, front to back. The order of their numbers is not the order of pixels.
    SampleRange pixel(std::size_t i) const {
        const Word &word = words_[i / 64];
        const std::uint64_t bit = std::uint64_t{1} << (i % 64);
        if (!(word.shown & bit)) return {i, i};
        if (!(word.replaced & bit)) return {i, i + 1};
        const SampleRange range =
            replaced_.pixel(word.replaced_before + std::size_t(std::popcount(word.replaced & (bit - 1))));
        return {pixels_ + range.from, pixels_ + range.to};
    }

    float z(std::uint64_t i) const { return i < pixels_ ? z_[i] : replaced_.z[i - pixels_]; }
    float z_back(std::uint64_t i) const {
        return i < pixels_ || replaced_.z_back.empty() ? z(i) : replaced_.z_back[i - pixels_];
    }
    float weight(std::uint64_t i) const { return i < pixels_ ? 1 : replaced_.weight[i - pixels_]; }
    float value(std::size_t channel, std::uint64_t i) const {
        return i < pixels_ ? planes_[channel][i] : replaced_.values[channel][i - pixels_];
    }

    bool deep() const { return deep_; }
    bool has_volumes() const { return !replaced_.z_back.empty(); }
    // Whether the sample is one of several parts that a pixel of a deep view shows.
    bool is_part(std::uint64_t i) const { return deep_ && i >= pixels_; }
    // Whether both parts lie in one pixel.
    bool in_one_pixel(std::uint64_t a, std::uint64_t b) const { return pixel_of_part(a) == pixel_of_part(b); }
    // Whether the pixel shows exactly one sample, which is not a part.
    bool is_single(std::size_t pixel) const {
        const SampleRange samples = this->pixel(pixel);
        return samples.size() == 1 && !is_part(samples.front());
    }

    // Sets `out` for pixels from `first` on, to the value of the front sample, or to the depth of the only sample. A
    // pixel without samples has the value 0; the depth is NaN if the pixel has no sample, several samples or a part.
    void front_values(std::size_t channel, std::size_t first, std::span<float> out) const;
    void single_depths(std::size_t first, std::span<float> out) const;

    // The depths of all pixels, including those that show nothing, before replace(); in a deep view, the depths of
    // front samples, 0 where there is none.
    std::span<const float> depths() const { return z_; }
    Image image() const;
    // Compares the bits of depths, then of values.
    std::strong_ordering operator<=>(const ViewSamples &other) const;

    // To be called before samples are replaced. Adds `by` to all depths, and keeps the channels of these names, in this
    // order.
    void move_back(double by);
    void keep_channels(std::span<const Channel> kept);

    // Sets the depth of a sample that replace() did not add; not for a part.
    void set_z(std::uint64_t i, float z);

    // Replaces the sample of each pixel for which changes(pixel) is true by those that fill(pixel, out) appends to the
    // last pixel of `out`, if any. Rows run in parallel. It may be called once, and not for a deep view.
    void replace(const std::function<bool(std::size_t pixel)> &changes,
                 const std::function<void(std::size_t pixel, Ldi &out)> &fill);

    // Frees all samples; the windows stay.
    void forget();

    // The number of samples in rows [first, end), counted from the top.
    std::uint64_t count(std::size_t first, std::size_t end) const;
    // The same rows as an LDI.
    Ldi rows(std::size_t first, std::size_t end) const;
    Ldi as_ldi() const { return rows(0, std::size_t(windows.height())); }

private:
    using MakePlane = Plane (*)(std::span<const float>);
    ViewSamples(const View &view, std::span<const Channel> channels, MakePlane plane_of);
    Ldi empty() const;
    std::size_t pixel_of_part(std::uint64_t i) const; // a pixel of `replaced_`
    void count_replaced();
    void take_values(Ldi &samples);
    void move_parts_back(double by);
    void find_shown(std::span<const float> covers);
    // Calls visit(i) for `count` pixels from `first` on that show nothing or whose sample was replaced.
    template <typename Visit>
    void for_each_changed(std::size_t first, std::size_t count, const Visit &visit) const;

    struct Word { // 64 pixels, from the lowest bit on
        std::uint64_t shown = 0, replaced = 0;
        std::uint32_t replaced_before = 0; // pixels
    };

    std::size_t pixels_;
    bool deep_ = false;
    std::vector<Plane> planes_; // [channel]
    std::span<const float> z_;  // the view's depths, or `moved_`
    std::vector<float> moved_;
    std::vector<Word> words_;
    Ldi replaced_; // its pixels are the replaced ones
};

// The index of the view's channel with that name. Throws Error, naming the view, if it is missing.
std::size_t channel_of(const std::string &view, std::span<const Channel> channels, const Channel &channel);

inline float alpha_at(const ViewSamples &view, std::size_t alpha_channel, std::uint64_t index) {
    return alpha_channel == npos ? 1.0f : view.value(alpha_channel, index);
}

// Appends a weighted sum of samples of the view to the last pixel of `out`.
void append(Ldi &out, const ViewSamples &from, float z, float weight, std::span<const Term> terms);

// A view whose pixels are held as packed samples. The checks and the warp work on it. Most of the
// memory of a warp is its five views, and packed ones take half the memory of pictures.

struct PackedView {
    std::string name; // for messages
    ViewSamples samples;
    Imath::V2d position{0, 0}; // as in View
    Framing framing = {};

    PackedView(const View &view); // refers to the pixels of the view, which must outlive this
    PackedView(View &&view);      // takes and packs them
    // A deep picture, tidy. If no pixel holds more than one point, it becomes a flat view.
    PackedView(std::string name, Ldi &&samples);
};

std::vector<PackedView> referring_to(std::span<const View> views);
std::vector<PackedView> packed(std::vector<View> &&views); // one at a time

// The view as a picture. The view must not be deep, and must still have the samples that it was made with.
View unpacked(const PackedView &view);

// Like place_views() of view/lens_views.h.
Camera place_views(std::span<PackedView> views, std::span<const StatedView> stated);

} // namespace sparselens
