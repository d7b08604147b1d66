#include "deep/view_samples.h"

#include "base/error.h"
#include "base/parallel.h"
#include "warp/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace sparselens {

ViewSamples::ViewSamples(const View &view, std::span<const Channel> of_channels)
    : ViewSamples(view, of_channels, Plane::of) {}

ViewSamples::ViewSamples(View &&view, std::span<const Channel> of_channels)
    : ViewSamples(view, of_channels, Plane::packed) {
    moved_ = std::move(view.z);
    z_ = moved_;
    view.image.values = {};
    view.image.values.shrink_to_fit();
}

ViewSamples::ViewSamples(const View &view, std::span<const Channel> of_channels, MakePlane plane_of)
    : windows(view.image.windows), channels(of_channels.begin(), of_channels.end()),
      pixels_(windows.pixels()), z_(view.z), words_(pieces_of(pixels_, std::size_t{64})) {
    std::vector<std::span<const float>> planes;
    for (const Channel &channel : channels)
        planes.push_back(view.image.plane(channel_of(view.name, view.image.channels, channel)));
    planes_.resize(planes.size());
    parallel_for(planes.size(), [&](std::size_t k) { planes_[k] = plane_of(planes[k]); });
    const std::size_t alpha = find_channel(view.image.channels, "A");
    find_shown(alpha == npos ? std::span<const float>() : view.image.plane(alpha));
    replaced_ = empty();
    replaced_.begin.assign(1, 0);
}

// `covers`: the coverage of each pixel; empty: all are covered.
void ViewSamples::find_shown(std::span<const float> covers) {
    parallel_ranges(words_.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = 64 * begin; i < std::min(64 * end, pixels_); ++i)
            if (z_[i] > 0 && (covers.empty() || covers[i] != 0))
                words_[i / 64].shown |= std::uint64_t{1} << (i % 64);
    });
}

template <typename Visit>
void ViewSamples::for_each_changed(std::size_t first, std::size_t count, const Visit &visit) const {
    for (std::size_t begin = first; begin < first + count;) {
        const std::size_t end = std::min(begin / 64 * 64 + 64, first + count);
        const Word &word = words_[begin / 64];
        for (std::uint64_t changed = (~word.shown | word.replaced) >> (begin % 64); changed != 0;
             changed &= changed - 1) {
            const std::size_t i = begin + std::size_t(std::countr_zero(changed));
            if (i >= end) break;
            visit(i);
        }
        begin = end;
    }
}

void ViewSamples::front_values(std::size_t channel, std::size_t first, std::span<float> out) const {
    planes_[channel].copy(first, out);
    for_each_changed(first, out.size(), [&](std::size_t i) {
        const SampleRange samples = pixel(i);
        out[i - first] = samples.empty() ? 0 : value(channel, samples.front());
    });
}

void ViewSamples::single_depths(std::size_t first, std::span<float> out) const {
    std::ranges::copy(z_.subspan(first, out.size()), out.begin());
    for_each_changed(first, out.size(), [&](std::size_t i) {
        const SampleRange samples = pixel(i);
        const bool single = samples.size() == 1 && !is_part(samples.front());
        out[i - first] = single ? z(samples.front()) : std::numeric_limits<float>::quiet_NaN();
    });
}

Image ViewSamples::image() const {
    Image image(windows, channels);
    for (std::size_t k = 0; k < planes_.size(); ++k)
        for (std::size_t i = 0; i < pixels_; ++i) image.plane(k)[i] = planes_[k][i];
    return image;
}

std::strong_ordering ViewSamples::operator<=>(const ViewSamples &other) const {
    const auto by_bits = [](float a, float b) {
        return std::bit_cast<std::uint32_t>(a) <=> std::bit_cast<std::uint32_t>(b);
    };
    const auto compared = [&](std::span<const float> a, std::span<const float> b) {
        return std::lexicographical_compare_three_way(a.begin(), a.end(), b.begin(), b.end(), by_bits);
    };
    if (const auto by_depth = compared(z_, other.z_); by_depth != 0) return by_depth;
    for (std::size_t k = 0; k < std::min(planes_.size(), other.planes_.size()); ++k)
        for (std::size_t i = 0; i < pixels_; ++i)
            if (const auto by_value = by_bits(planes_[k][i], other.planes_[k][i]); by_value != 0)
                return by_value;
    if (const auto by_count = planes_.size() <=> other.planes_.size(); by_count != 0) return by_count;
    if (const auto by_parts = replaced_.begin <=> other.replaced_.begin; by_parts != 0) return by_parts;
    if (const auto by_depth = compared(replaced_.z, other.replaced_.z); by_depth != 0) return by_depth;
    for (std::size_t k = 0; k < planes_.size(); ++k)
        if (const auto by_value = compared(replaced_.values[k], other.replaced_.values[k]); by_value != 0)
            return by_value;
    return compared(replaced_.z_back, other.replaced_.z_back);
}

void ViewSamples::move_back(double by) {
    if (deep_) return move_parts_back(by);
    if (moved_.empty()) moved_.assign(z_.begin(), z_.end());
    z_ = moved_;
    for (float &z : moved_) z = float(double(z) + by);
    for (std::size_t i = 0; i < pixels_; ++i) // samples that now lie behind the camera show nothing
        if (!(z_[i] > 0)) words_[i / 64].shown &= ~(std::uint64_t{1} << (i % 64));
}

void ViewSamples::keep_channels(std::span<const Channel> kept) {
    std::vector<Plane> planes;
    std::vector<std::vector<float>> replaced;
    for (const Channel &channel : kept) {
        const std::size_t k = find_channel(channels, channel.name);
        planes.push_back(std::move(planes_[k]));
        replaced.push_back(std::move(replaced_.values[k]));
    }
    planes_ = std::move(planes);
    channels.assign(kept.begin(), kept.end());
    replaced_.channels = channels;
    replaced_.values = std::move(replaced);
}

// An LDI of these channels, without pixels.
Ldi ViewSamples::empty() const {
    Ldi ldi;
    ldi.windows = windows;
    ldi.channels = channels;
    ldi.values.resize(channels.size());
    return ldi;
}

std::uint64_t ViewSamples::count(std::size_t first_row, std::size_t end_row) const {
    const auto width = std::size_t(windows.width());
    std::uint64_t count = 0;
    for (std::size_t p = first_row * width; p < end_row * width; ++p) count += pixel(p).size();
    return count;
}

void ViewSamples::set_z(std::uint64_t i, float z) {
    if (moved_.empty()) moved_.assign(z_.begin(), z_.end());
    z_ = moved_;
    moved_[i] = z;
}

void ViewSamples::count_replaced() {
    std::uint32_t before = 0;
    for (Word &word : words_) {
        word.replaced_before = before;
        before += std::uint32_t(std::popcount(word.replaced));
    }
}

void ViewSamples::replace(const std::function<bool(std::size_t pixel)> &changes,
                          const std::function<void(std::size_t pixel, Ldi &out)> &fill) {
    const Ldi like = empty();
    const auto width = std::size_t(windows.width());
    std::vector<Ldi> rows(std::size_t(windows.height()));
    std::vector<std::vector<std::size_t>> replaced(rows.size()); // pixels
    parallel_for(rows.size(), [&](std::size_t y) {
        Ldi &row = rows[y] = like;
        row.begin.assign(2, 0);
        for (std::size_t i = y * width; i < (y + 1) * width; ++i) {
            if (!changes(i)) continue;
            fill(i, row);
            if (row.begin.back() == row.begin.rbegin()[1]) continue;
            replaced[y].push_back(i);
            row.begin.push_back(row.begin.back());
        }
        row.begin.pop_back();
    });
    for (const std::vector<std::size_t> &row : replaced)
        for (const std::size_t i : row) words_[i / 64].replaced |= std::uint64_t{1} << (i % 64);
    count_replaced();
    replaced_ = concatenate(like, std::move(rows));
}

void ViewSamples::forget() {
    planes_.clear();
    z_ = {};
    moved_ = {};
    words_ = {};
    replaced_ = {};
}

Ldi ViewSamples::rows(std::size_t first, std::size_t end) const {
    Ldi ldi = empty();
    ldi.windows.data.min.y += int(first);
    ldi.windows.data.max.y = windows.data.min.y + int(end) - 1;
    ldi.begin.assign(1, 0);
    const auto width = std::size_t(windows.width());
    for (std::size_t p = first * width; p < end * width; ++p) {
        for (const std::uint64_t i : pixel(p)) {
            ldi.z.push_back(z(i));
            if (has_volumes()) ldi.z_back.push_back(z_back(i));
            ldi.weight.push_back(weight(i));
            for (std::size_t k = 0; k < channels.size(); ++k) ldi.values[k].push_back(value(k, i));
        }
        ldi.begin.push_back(ldi.z.size());
    }
    return ldi;
}

std::size_t channel_of(const std::string &view, std::span<const Channel> channels, const Channel &channel) {
    const std::size_t found = find_channel(channels, channel.name);
    if (found == npos)
        throw Error(fmt::format("{}: has no channel {}, which the centre view has", view, channel.name));
    return found;
}

void append(Ldi &out, const ViewSamples &from, float z, float weight, std::span<const Term> terms) {
    out.z.push_back(z);
    out.weight.push_back(weight);
    merge_values(out, from.channels, terms, [&](std::size_t k, std::uint64_t i) { return from.value(k, i); });
    ++out.begin.back();
}

namespace {

// Whether a pixel of a deep picture differs from one of a flat view, which holds one sample: a point that covers
// something.
bool holds_parts(const Ldi &ldi, std::size_t alpha, const SampleRange &samples) {
    if (samples.size() != 1) return !samples.empty();
    return back_at(ldi, samples.front()) > ldi.z[samples.front()] ||
           !(alpha_at(ldi, alpha, samples.front()) > 0);
}

} // namespace

ViewSamples::ViewSamples(Ldi &&samples)
    : windows(samples.windows), channels(samples.channels), pixels_(windows.pixels()), deep_(true),
      moved_(pixels_), words_(pieces_of(pixels_, std::size_t{64})) {
    z_ = moved_;
    replaced_ = empty();
    replaced_.begin.assign(1, 0);
    const std::size_t alpha = samples.alpha();
    for (std::size_t p = 0; p < pixels_; ++p) {
        const SampleRange own = samples.pixel(p);
        if (own.empty()) continue;
        moved_[p] = samples.z[own.front()];
        const std::uint64_t bit = std::uint64_t{1} << (p % 64);
        words_[p / 64].shown |= bit;
        if (!holds_parts(samples, alpha, own)) continue;
        words_[p / 64].replaced |= bit;
        for_shares(samples, alpha, own, [&](std::uint64_t i, double left) {
            replaced_.z.push_back(samples.z[i]);
            if (!samples.z_back.empty()) replaced_.z_back.push_back(samples.z_back[i]);
            replaced_.weight.push_back(std::max(float(left), WarpTuning::estimate_weight));
        });
        replaced_.begin.push_back(replaced_.z.size());
    }
    count_replaced();
    take_values(samples);
}

// Takes them channel by channel, so that no two copies of all channels are held.
void ViewSamples::take_values(Ldi &samples) {
    planes_.resize(channels.size());
    for (std::size_t k = 0; k < channels.size(); ++k) {
        std::vector<float> front(pixels_);
        std::vector<float> &parts = replaced_.values[k];
        parts.reserve(replaced_.z.size());
        for (std::size_t p = 0; p < pixels_; ++p) {
            const SampleRange own = samples.pixel(p);
            if (own.empty()) continue;
            front[p] = samples.values[k][own.front()];
            if (pixel(p).front() >= pixels_)
                for (const std::uint64_t i : own) parts.push_back(samples.values[k][i]);
        }
        planes_[k] = Plane::packed(front);
        std::vector<float>().swap(samples.values[k]);
    }
}

std::size_t ViewSamples::pixel_of_part(std::uint64_t i) const {
    return std::size_t(std::ranges::upper_bound(replaced_.begin, i - pixels_) - replaced_.begin.begin());
}

namespace {

// Moves samples back, and leaves out those that then lie behind the camera.
Ldi moved(const Ldi &samples, double by) {
    return build_by_pixels(samples, [&](std::size_t pixel, Ldi &out) {
        for (const std::uint64_t i : samples.pixel(pixel)) {
            MergedSample sample = sample_at(samples, i);
            sample.z = float(double(sample.z) + by);
            sample.z_back = float(double(sample.z_back) + by);
            const Term whole{i, 1};
            sample.terms = {&whole, 1};
            if (sample.z > 0) append(out, samples, sample);
        }
    });
}

} // namespace

void ViewSamples::move_parts_back(double by) { *this = ViewSamples(moved(as_ldi(), by)); }

namespace {

bool is_flat(const Ldi &ldi) {
    for (std::size_t p = 0; p + 1 < ldi.begin.size(); ++p)
        if (ldi.pixel(p).size() > 1) return false;
    return ldi.z_back.empty() || ldi.z_back == ldi.z;
}

// A flat view. Pixels of depth 0 show nothing.
View flat_view(const std::string &name, const Ldi &ldi) {
    View view{name, Image(ldi.windows, ldi.channels), std::vector<float>(ldi.windows.pixels())};
    for (std::size_t p = 0; p < view.z.size(); ++p)
        for (const std::uint64_t i : ldi.pixel(p)) {
            view.z[p] = ldi.z[i];
            for (std::size_t k = 0; k < ldi.channels.size(); ++k) view.image.plane(k)[p] = ldi.values[k][i];
        }
    return view;
}

ViewSamples samples_of(const std::string &name, Ldi &&ldi) {
    if (!is_flat(ldi)) return ViewSamples(std::move(ldi));
    const std::vector<Channel> channels = ldi.channels;
    return {flat_view(name, std::exchange(ldi, {})), channels};
}

} // namespace

PackedView::PackedView(const View &view)
    : name(view.name), samples(view, view.image.channels), position(view.position), framing(view.framing) {}

PackedView::PackedView(View &&view)
    : name(std::move(view.name)), samples(std::move(view), view.image.channels), position(view.position),
      framing(view.framing) {}

PackedView::PackedView(std::string called, Ldi &&ldi)
    : name(std::move(called)), samples(samples_of(name, std::move(ldi))) {}

std::vector<PackedView> referring_to(std::span<const View> views) { return {views.begin(), views.end()}; }

std::vector<PackedView> packed(std::vector<View> &&views) {
    std::vector<PackedView> taken;
    for (View &view : views) taken.emplace_back(std::move(view));
    return taken;
}

View unpacked(const PackedView &view) {
    assert(!view.samples.deep());
    return {view.name,
            view.samples.image(),
            {view.samples.depths().begin(), view.samples.depths().end()},
            view.position,
            view.framing};
}

Camera place_views(std::span<PackedView> views, std::span<const StatedView> stated) {
    PlacedCameras placed = place_cameras(stated);
    for (std::size_t i = 0; i < views.size(); ++i) {
        const ViewPlace &place = placed.places[i];
        views[i].position = place.position;
        views[i].framing = place.framing;
        if (place.framing.forward != 0) views[i].samples.move_back(place.framing.forward);
    }
    return std::move(placed.centre);
}

} // namespace sparselens
