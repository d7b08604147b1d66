#include "finish/finish_picture.h"

#include "base/channel_kind.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "finish/fireflies.h"
#include "finish/frames_around.h"
#include "finish/tuning.h"
#include "finish/window_means.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace sparselens {

namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN(); // where a render has no value

// Sums of fourth powers of larger values may overflow, so brighter pixels stay as gathered.
constexpr float largest = 1e8f;

bool is_usable(float value) { return std::abs(value) <= largest; } // false for NaN

bool is_finished(const Channel &channel) { return is_light(channel) && channel.type != PixelType::uint32; }

// The values of a channel over the pixels of `windows`; `nothing` outside of `box`, a part of its data window.
Values over(const Image &image, std::size_t channel, const Windows &windows, const Imath::Box2i &box) {
    const Grid grid = windows.grid(), own = image.windows.grid();
    const std::span<const float> plane = image.plane(channel);
    Values values(grid.size());
    parallel_for(std::size_t(grid.height()), [&](std::size_t row) {
        for (int x = 0; x < grid.width(); ++x) {
            const Imath::V2i at = grid.pixel(Position(x, int(row)));
            values[grid.index(at)] = box.intersects(at) ? plane[own.index(at)] : nothing;
        }
    });
    return values;
}

// How many samples each pixel of a render has, as its channel of counts tells.
Values counts_of(const Render &render, const Windows &windows, const Imath::Box2i &box) {
    for (std::size_t c = 0; c < render.image.channels.size(); ++c) {
        const std::string name = lower_case(render.image.channels[c].name);
        const bool part = name.ends_with("debug sample count.x");
        if (!part && name != "samples" && name != "samplecount") continue;
        Values counts = over(render.image, c, windows, box);
        if (part)
            for (float &count : counts) count *= float(render.samples);
        return counts;
    }
    return Values(windows.grid().size(), float(render.samples));
}

void check_window(const Render &render, const Windows &windows) {
    const Windows &own = render.image.windows;
    const bool is_part =
        common_box(own.display, windows.display) == own.display && own.display.min != windows.display.min;
    if (own.display != windows.display && !is_part)
        throw Error(
            fmt::format("{}: its picture is {}, the gathered one {}: render both with the same camera and "
                        "size",
                        render.name, size_text(own.display), size_text(windows.display)));
    if (own.pixel_aspect != windows.pixel_aspect)
        throw Error(
            fmt::format("{}: its pixel aspect ratio is {:g}, that of the gathered picture {:g}: render "
                        "both with the same camera",
                        render.name, own.pixel_aspect, windows.pixel_aspect));
}

// Leaves only finite values: where a render has none, the gathered value; where the gathered picture has none either,
// 0.
void repair(Colours &gathered, std::vector<Halves *> halves) {
    for (std::size_t c = 0; c < gathered.size(); ++c)
        parallel_ranges(gathered[c].size(), std::size_t(1) << 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                float &g = gathered[c][i];
                if (std::isfinite(g)) g = std::clamp(g, -largest, largest);
                if (!is_usable(g)) g = (*halves[0])[0][c][i];
                if (!is_usable(g)) g = 0;
            }
        });
    // A pixel is taken or left as a whole, so that its colours stay consistent.
    parallel_ranges(gathered[0].size(), std::size_t(1) << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (Halves *pair : halves) {
                bool whole = true;
                for (const Colours &half : *pair)
                    for (const Values &channel : half) whole &= is_usable(channel[i]);
                if (whole) continue;
                for (Colours &half : *pair)
                    for (std::size_t c = 0; c < half.size(); ++c) half[c][i] = gathered[c][i];
            }
    });
}

Halves taken(TwoHalves &from, const std::vector<std::size_t> &channels) {
    Halves halves;
    for (const std::size_t c : channels) {
        auto planes = from.take(c);
        for (std::size_t k = 0; k < 2; ++k) halves[k].push_back(std::move(planes[k]));
    }
    return halves;
}

// The same channels of another gathered picture, over the pixels of the one to finish; empty if it lacks one of them.
Colours of_other(const PictureToFinish &picture, const Image &other,
                 const std::vector<std::size_t> &channels) {
    Colours colours;
    for (const std::size_t c : channels) {
        const std::size_t from = find_channel(other.channels, picture.gathered.channels[c].name);
        if (from == npos) return {};
        colours.push_back(over(other, from, picture.gathered.windows, other.windows.data));
    }
    return colours;
}

// Averages a copy of the layer's rays with those of the frames around.
void take_around(LayerToFinish &layer, PictureToFinish &picture, const std::vector<std::size_t> &channels) {
    std::vector<FrameOfLayer> around;
    for (FrameAround &near : picture.around) {
        FrameOfLayer other{of_other(picture, near.gathered, channels), {}};
        if (other.gathered.empty() ||
            !std::ranges::all_of(channels, [&](std::size_t c) { return near.rays.has(c); }))
            continue;
        other.rays = taken(near.rays, channels);
        repair(other.gathered, {&other.rays});
        around.push_back(std::move(other));
    }
    if (around.empty()) return;
    FrameOfLayer frame{std::move(layer.gathered), std::move(layer.rays)};
    layer.averaged = averaged_rays(frame, around, layer.grid);
    layer.gathered = std::move(frame.gathered);
    layer.rays = std::move(frame.rays);
}

LayerToFinish layer_of(PictureToFinish &picture, const std::vector<std::size_t> &channels) {
    const Windows &windows = picture.gathered.windows;
    LayerToFinish layer{
        windows.grid().array(), {}, taken(picture.rays, channels), picture.rays.samples(), {}};
    for (const std::size_t c : channels) {
        const auto plane = picture.gathered.plane(c);
        layer.gathered.emplace_back(plane.begin(), plane.end());
    }
    const auto has_all = [&](const auto &has) { return std::ranges::all_of(channels, has); };
    for (TwoHalves &denoised : picture.denoised)
        if (has_all([&](std::size_t c) { return denoised.has(c); }))
            layer.given.push_back(taken(denoised, channels));
    for (const Image &other : picture.others)
        if (const Colours same = of_other(picture, other, channels); !same.empty())
            layer.given.push_back({same, same});
    std::vector<Halves *> all{&layer.rays};
    for (Halves &given : layer.given) all.push_back(&given);
    repair(layer.gathered, all);
    take_around(layer, picture, channels);
    return layer;
}

// The part of a layer outside of which no picture shows anything. It alone is finished, so that empty rows and columns
// around it change nothing.
class FilledPart {
public:
    explicit FilledPart(const LayerToFinish &layer) : grid_(layer.grid), part_(layer.grid.box()) {
        Imath::Box2i box;
        const auto add = [&](const Colours &picture) {
            for (const Values &plane : picture)
                for (std::size_t i = 0; i < plane.size(); ++i)
                    if (plane[i] != 0) box.extendBy(grid_.position(i) - Position());
        };
        add(layer.gathered);
        for (const Colours &half : layer.rays) add(half);
        for (const Halves &given : layer.given)
            for (const Colours &half : given) add(half);
        if (!box.isEmpty()) part_ = {Position() + box.min, Position() + box.max};
    }
    void cut(LayerToFinish &layer) const {
        if (is_whole()) return;
        layer.grid = ArrayGrid(width(), height());
        const auto cut_all = [&](Colours &picture) {
            for (Values &plane : picture) cut(plane);
        };
        cut_all(layer.gathered);
        for (std::size_t k = 0; k < 2; ++k) {
            cut_all(layer.rays[k]);
            cut_all(layer.averaged[k]);
            for (Halves &given : layer.given) cut_all(given[k]);
            cut(layer.samples.by_pixel[k]);
        }
        cut(layer.nothing);
    }
    Imath::Box2i box(const Grid &grid) const { return {grid.pixel(part_.min), grid.pixel(part_.max)}; }
    // Puts the part back, with this value around it.
    void spread(Values &plane, float around) const {
        if (is_whole()) return;
        const Values part = std::exchange(plane, Values(grid_.size(), around));
        for (int row = 0; row < height(); ++row)
            std::copy_n(part.begin() + std::ptrdiff_t(row) * width(), width(), plane.begin() + begin_of(row));
    }

private:
    bool is_whole() const { return part_ == grid_.box(); }
    int width() const { return part_.max.column - part_.min.column + 1; }
    int height() const { return part_.max.row - part_.min.row + 1; }
    // The index of the first value in a row of the part.
    std::ptrdiff_t begin_of(int row) const {
        return std::ptrdiff_t(grid_.index(part_.min + Imath::V2i(0, row)));
    }
    template <typename Plane>
    void cut(Plane &plane) const {
        if (plane.empty()) return;
        Plane part;
        for (int row = 0; row < height(); ++row)
            part.insert(part.end(), plane.begin() + begin_of(row), plane.begin() + begin_of(row) + width());
        plane = std::move(part);
    }

    ArrayGrid grid_;
    PositionBox part_;
};

// Light groups are layers that add up to the beauty. For each of its colours: their channels, then that of the beauty.
// Their names are alike up to the last _.
std::vector<std::vector<std::size_t>> light_groups(const PictureToFinish &picture,
                                                   const std::vector<std::size_t> &beauty) {
    const Image &gathered = picture.gathered;
    std::map<std::string, std::vector<std::size_t>> alike;
    for (const std::vector<std::size_t> &layer : colour_layers(gathered.channels))
        for (const std::size_t c : layer) {
            const std::string &name = gathered.channels[c].name;
            if (const std::size_t dot = name.rfind('.'); dot != npos && picture.rays.has(c))
                alike[name.substr(0, name.rfind('_', dot) + 1) + name.substr(dot)].push_back(c);
        }
    std::vector<std::vector<std::size_t>> found;
    for (auto &[name, group] : alike)
        for (const std::size_t c : beauty) {
            if (colour_part(gathered.channels[c]) != colour_part(gathered.channels[group[0]])) continue;
            double apart = 0, all = 0;
            for (std::size_t i = 0; i < gathered.plane(c).size(); ++i) {
                double lacks = double(gathered.plane(c)[i]);
                all += std::abs(lacks);
                for (const std::size_t of : group) lacks -= double(gathered.plane(of)[i]);
                apart += std::abs(lacks);
            }
            if (!(apart <= FinishTuning::groups_apart * all)) continue;
            group.push_back(c);
            found.push_back(group);
            break;
        }
    return found;
}

// Gives light groups what they lack of the beauty, by how much light each has.
void add_up(Image &picture, const std::vector<std::size_t> &group) {
    const std::span<const std::size_t> layers(group.data(), group.size() - 1);
    for (std::size_t i = 0; i < picture.plane(group.back()).size(); ++i) {
        float lacks = picture.plane(group.back())[i], light = 0;
        for (const std::size_t c : layers) {
            lacks -= picture.plane(c)[i];
            light += std::abs(picture.plane(c)[i]);
        }
        if (!is_usable(lacks)) continue;
        for (const std::size_t c : layers) {
            float &v = picture.plane(c)[i];
            v += light > 0 ? lacks * (std::abs(v) / light) : lacks / float(layers.size());
        }
    }
}

} // namespace

TwoHalves::TwoHalves(const Image &gathered)
    : windows_(gathered.windows), channels_(gathered.channels), has_(channels_.size()) {
    if (const std::size_t green = find_channel(channels_, rgb_names[1]); green != npos)
        gathered_green_.assign(gathered.plane(green).begin(), gathered.plane(green).end());
    for (std::size_t c = 0; c < channels_.size(); ++c) has_[c] = is_finished(channels_[c]);
    for (auto &half : sums_) half.resize(channels_.size());
    for (Values &counts : counts_) counts.assign(windows_.grid().size(), 0.0f);
    lit_.resize(windows_.grid().size());
    for (std::size_t c = 0; c < channels_.size(); ++c)
        for (std::size_t i = 0; has_[c] && i < lit_.size(); ++i)
            lit_[i] = lit_[i] || gathered.plane(c)[i] != 0;
}

std::vector<bool> TwoHalves::without_light() const {
    std::vector<bool> found;
    for (std::size_t c = 0; c < channels_.size(); ++c)
        if (has_[c] && colour_part(channels_[c]) == ColourPart::coverage) found.assign(lit_.size(), true);
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = !lit_[i] && has_both(i);
    for (const std::vector<Values> &half : sums_)
        for (const Values &sum : half)
            for (std::size_t i = 0; i < sum.size() && i < found.size(); ++i)
                if (sum[i] != 0) found[i] = false;
    return found;
}

Imath::Box2i TwoHalves::shown(const Image &image) const {
    const Grid own = image.windows.grid();
    Imath::Box2i box;
    for (std::size_t i = 0; i < own.size(); ++i)
        for (std::size_t c = 0; c < image.channels.size(); ++c)
            if (image.plane(c)[i] != 0) {
                box.extendBy(own.pixel(i));
                break;
            }
    for (std::size_t i = 0; i < lit_.size(); ++i) {
        const Imath::V2i at = windows_.pixel(i);
        if (lit_[i] && own.contains(at) && !box.intersects(at)) return box;
    }
    return image.windows.data;
}

bool TwoHalves::complete() const {
    for (std::size_t i = 0; i < counts_[0].size(); ++i)
        if (has_both(i)) return true;
    return false;
}

std::size_t TwoHalves::missing() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < counts_[0].size(); ++i)
        if (!has_both(i) && windows_.display.intersects(windows_.pixel(i))) ++count;
    return count;
}

RayCounts TwoHalves::samples() const {
    RayCounts samples({0, 0}, counts_);
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < counts_[0].size(); ++i) {
        if (!has_both(i)) continue;
        ++pixels;
        for (std::size_t k = 0; k < 2; ++k) samples.mean[k] += double(counts_[k][i]);
    }
    for (std::size_t k = 0; k < 2; ++k) {
        samples.mean[k] /= double(std::max(pixels, std::size_t(1)));
        for (std::size_t i = 0; i < counts_[k].size(); ++i)
            if (!has_both(i)) samples.by_pixel[k][i] = float(samples.mean[k]);
    }
    return samples;
}

void TwoHalves::add(const Render &render) {
    check_window(render, windows_);
    const Imath::Box2i box = shown(render.image);
    Values counts = counts_of(render, windows_, box);
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (!has_[c]) continue;
        const std::size_t from = find_channel(render.image.channels, channels_[c].name);
        has_[c] = from != npos;
        if (!has_[c]) continue;
        const Values values = over(render.image, from, windows_, box);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (!is_usable(values[i])) counts[i] = 0;
    }
    double first = 0, second = 0; // the samples that there are
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (!(is_usable(counts[i]) && counts[i] > 0)) counts[i] = 0;
        if (counts[i] > 0) first += double(counts_[0][i]), second += double(counts_[1][i]);
    }
    const std::size_t half = first <= second ? 0 : 1;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (!has_[c]) continue;
        const Values values =
            over(render.image, find_channel(render.image.channels, channels_[c].name), windows_, box);
        Values &sum = sums_[half][c];
        if (sum.empty()) sum.assign(values.size(), nothing);
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const float before = counts_[half][i], share = counts[i] / (before + counts[i]);
            if (counts[i] > 0) sum[i] = before > 0 ? sum[i] + share * (values[i] - sum[i]) : values[i];
        }
    }
    for (std::size_t i = 0; i < counts.size(); ++i) counts_[half][i] += counts[i];
}

void TwoHalves::add_noisy(const Render &render) {
    check_window(render, windows_);
    if (const std::size_t from = find_channel(render.image.channels, rgb_names[1]); from != npos) {
        const Imath::Box2i box = shown(render.image);
        const Values values = over(render.image, from, windows_, box);
        Noisy own{render.name, {values.begin(), values.end()}, render.samples, box};
        for (const Noisy &other : noisy_)
            if (own.window.intersects(other.window)) compare(other, own);
        noisy_.push_back(std::move(own));
    }
    add(render);
}

void TwoHalves::compare(const Noisy &one, const Noisy &two) {
    const NoiseOfTwo noise = noise_of_two(one.green, two.green, gathered_green_, windows_.grid().array());
    if (noise.same())
        throw Error(fmt::format("{}: has the same noise as {}: render each with a seed of its own", two.name,
                                one.name));
    if (noise.alike > FinishTuning::noise_alike) {
        doubts_.push_back(
            fmt::format("{} and {} do not differ by noise, but as smooth pictures do: give renders of "
                        "one picture as they are, without denoising",
                        one.name, two.name));
        return;
    }
    for (const Imath::V2i &corner :
         {windows_.display.min, windows_.display.max}) // parts hold too little to tell
        if (!one.window.intersects(corner) || !two.window.intersects(corner)) return;
    const double told = one.samples * two.samples / (one.samples + two.samples);
    for (const auto &[render, share] : {std::pair(&one, noise.of_each[0]), std::pair(&two, noise.of_each[1])})
        if (share < FinishTuning::little_noise * told / render->samples)
            doubts_.push_back(
                fmt::format("{} has less noise than its samples tell: give renders as they are, without "
                            "denoising, and the right numbers of samples",
                            render->name));
}

std::array<Values, 2> TwoHalves::take(std::size_t channel) {
    return {std::move(sums_[0][channel]), std::move(sums_[1][channel])};
}

FinishedPicture finish_picture(PictureToFinish picture, Progress &progress) {
    if (!picture.rays.complete())
        throw Error(
            "no pixel has two renders: give two or more with different seeds, whose values are at most "
            "1e8");
    FinishedPicture finished;
    const std::vector<bool> empty = picture.rays.without_light();
    const auto colours = find_rgb(picture.gathered.channels);
    if (!all_found(colours) ||
        !std::ranges::all_of(colours, [&](std::size_t c) { return picture.rays.has(c); }))
        throw Error("the gathered picture and the renders have no R, G and B in common");
    const auto groups = light_groups(picture, {colours.begin(), colours.end()});
    for (const std::vector<std::size_t> &channels : colour_layers(picture.gathered.channels)) {
        if (!std::ranges::all_of(channels, [&](std::size_t c) { return picture.rays.has(c); })) {
            for (const std::size_t c : channels)
                finished.as_gathered.push_back(picture.gathered.channels[c].name);
            continue;
        }
        LayerToFinish layer = layer_of(picture, channels);
        layer.nothing = empty;
        const FilledPart part(layer);
        part.cut(layer);
        const bool beauty = std::ranges::find(channels, colours[0]) != channels.end(),
                   coverage = colour_part(picture.gathered.channels[channels[0]]) == ColourPart::coverage;
        // The renders' brightness includes that of fireflies.
        if (beauty) finished.warnings = check_lens(layer).warnings();
        if (!coverage) leave_out_fireflies(layer);
        FinishedLayer result = finish_layer(layer, progress);
        if (beauty) {
            finished.warnings.insert(finished.warnings.end(), picture.rays.doubts().begin(),
                                     picture.rays.doubts().end());
            finished.error = estimate_error(result, layer.rays, layer.samples, layer.grid);
            part.spread(finished.error.map, 0);
            finished.part = part.box(picture.gathered.windows.grid());
            finished.kept = std::move(result.kept);
            part.spread(finished.kept, 1);
            finished.samples = picture.rays.samples();
        }
        if (coverage)
            for (float &alpha : result.picture[0]) alpha = std::clamp(alpha, 0.0f, 1.0f);
        for (std::size_t k = 0; k < channels.size(); ++k) {
            part.spread(result.picture[k], 0);
            std::ranges::transform(result.picture[k], picture.gathered.plane(channels[k]),
                                   picture.gathered.plane(channels[k]).begin(), [](float made, float was) {
                                       return std::isfinite(was) && !is_usable(was) ? was : made;
                                   });
        }
    }
    for (const std::vector<std::size_t> &group : groups) add_up(picture.gathered, group);
    finished.image = std::move(picture.gathered);
    return finished;
}

} // namespace sparselens
