#include "deep/merge.h"

#include "base/matte.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "deep/flatten.h"
#include "kernels/lens_rules.h"

#include <algorithm>

namespace sparselens {

namespace {

// The channels of all parts, in the order in which parts first have them, each of the type with the most bits.
std::vector<Channel> all_channels(const std::vector<Ldi> &parts) {
    std::vector<Channel> all;
    for (const Ldi &part : parts)
        for (const Channel &channel : part.channels) {
            const std::size_t k = find_channel(all, channel.name);
            if (k == npos)
                all.push_back(channel);
            else if (all[k].type == PixelType::half)
                all[k].type = channel.type;
        }
    return all;
}

// The source of a part's samples in a channel: their own values, or one value for all.
struct Source {
    const std::vector<float> *values = nullptr;
    float otherwise = 0;
    float at(std::uint64_t i) const { return values ? (*values)[i] : otherwise; }
};

Source source_of(const Ldi &part, const std::vector<Channel> &all, std::size_t k) {
    const auto named = [&](const std::string &name, float otherwise) {
        const std::size_t found = find_channel(part.channels, name);
        return found == npos ? Source{nullptr, otherwise} : Source{&part.values[found], 0};
    };
    const bool covers = !holds_ids(all[k]) && coverage_of(all, k) == k;
    const Source own = named(all[k].name, 0);
    return own.values || !covers ? own : named("A", 1);
}

Source array_of(const std::vector<float> &values, float otherwise) {
    return values.empty() ? Source{nullptr, otherwise} : Source{&values, 0};
}

Windows all_windows(const std::vector<Ldi> &parts) {
    Windows windows = parts.front().windows;
    for (const Ldi &part : parts) windows.data.extendBy(part.windows.data);
    return windows;
}

// Calls visit(part, its samples, their destination) for every pixel and part.
template <typename Visit>
void for_each_run(const std::vector<Ldi> &parts, const Ldi &out, const Visit &visit) {
    const Imath::Box2i &data = out.windows.data;
    parallel_for(std::size_t(out.windows.height()), [&](std::size_t row) {
        const int y = data.min.y + int(row);
        for (int x = data.min.x; x <= data.max.x; ++x) {
            std::uint64_t to = out.pixel(out.windows.index(Imath::V2i(x, y))).from;
            for (std::size_t p = 0; p < parts.size(); ++p) {
                if (!parts[p].windows.data.intersects(Imath::V2i(x, y))) continue;
                const SampleRange samples = parts[p].pixel(parts[p].windows.index(Imath::V2i(x, y)));
                visit(p, samples, to);
                to += samples.size();
            }
        }
    });
}

std::vector<std::uint64_t> begin_of(const std::vector<Ldi> &parts, const Windows &windows) {
    std::vector<std::uint64_t> begin(windows.pixels() + 1, 0);
    for (const Ldi &part : parts)
        for (std::size_t row = 0, i = 0; row < std::size_t(part.windows.height()); ++row) {
            const Imath::V2i corner = part.windows.data.min;
            const std::size_t first = windows.index(Imath::V2i(corner.x, corner.y + int(row)));
            for (std::size_t x = 0; x < std::size_t(part.windows.width()); ++x, ++i)
                begin[first + x + 1] += part.pixel(i).size();
        }
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    return begin;
}

} // namespace

bool same_samples(const Ldi &layer, const Ldi &ldi) {
    const auto same = [&](std::vector<float> Ldi::*array) {
        return (layer.*array).empty() || layer.*array == ldi.*array;
    };
    return layer.windows == ldi.windows && layer.begin == ldi.begin && layer.z == ldi.z &&
           same(&Ldi::z_back) && same(&Ldi::dx) && same(&Ldi::dy) && same(&Ldi::image_z) && same(&Ldi::solid);
}

void add_layer(Ldi &ldi, Ldi layer, const std::string &name) {
    for (std::size_t k = 0; k < layer.channels.size(); ++k) {
        Channel channel = layer.channels[k];
        if (find_channel(ldi.channels, channel.name) != npos) channel.name = name + "." + channel.name;
        if (find_channel(ldi.channels, channel.name) != npos) continue;
        ldi.channels.push_back(channel);
        ldi.values.push_back(std::move(layer.values[k]));
    }
}

Ldi deep_merge(const std::vector<Ldi> &parts) {
    Ldi out;
    out.windows = all_windows(parts);
    out.channels = all_channels(parts);
    out.begin = begin_of(parts, out.windows);
    const auto fill = [&](std::vector<float> &to, const auto &source) {
        std::vector<Source> sources;
        for (const Ldi &part : parts) sources.push_back(source(part));
        to.resize(out.begin.back());
        for_each_run(parts, out, [&](std::size_t p, const SampleRange &samples, std::uint64_t at) {
            for (const std::uint64_t i : samples) to[at++] = sources[p].at(i);
        });
    };
    const auto some_have = [&](std::vector<float> Ldi::*array) {
        return std::ranges::any_of(parts, [&](const Ldi &part) { return !(part.*array).empty(); });
    };
    fill(out.z, [](const Ldi &part) { return array_of(part.z, 0); });
    if (some_have(&Ldi::z_back))
        fill(out.z_back,
             [](const Ldi &part) { return Source{part.z_back.empty() ? &part.z : &part.z_back}; });
    if (some_have(&Ldi::dx)) fill(out.dx, [](const Ldi &part) { return array_of(part.dx, 0); });
    if (some_have(&Ldi::dy)) fill(out.dy, [](const Ldi &part) { return array_of(part.dy, 0); });
    if (some_have(&Ldi::weight)) fill(out.weight, [](const Ldi &part) { return array_of(part.weight, 1); });
    if (some_have(&Ldi::image_z))
        fill(out.image_z,
             [](const Ldi &part) { return Source{part.image_z.empty() ? &part.z : &part.image_z}; });
    if (some_have(&Ldi::solid)) fill(out.solid, [](const Ldi &part) { return array_of(part.solid, 0); });
    out.values.resize(out.channels.size());
    for (std::size_t k = 0; k < out.channels.size(); ++k)
        fill(out.values[k], [&](const Ldi &part) { return source_of(part, out.channels, k); });
    return out;
}

Holdout::Holdout(Ldi ldi) : ldi_(std::move(ldi)), alpha_(ldi_.alpha()) {}

double Holdout::passes(int x, int y, double z) const {
    if (!ldi_.windows.data.intersects(Imath::V2i(x, y))) return 1;
    const std::size_t pixel = ldi_.windows.index(Imath::V2i(x, y));
    double passed = 1;
    for (const std::uint64_t i : ldi_.pixel(pixel)) {
        if (!(passed > 0)) break;
        const double front = ldi_.z[i], back = back_at(ldi_, i);
        if (!kernels::is_held_out(front, z)) break;
        const double clear = std::max(0.0, 1 - double(alpha_at(ldi_, alpha_, i)));
        passed *= kernels::passes_part(front, back, clear, z);
    }
    return passed;
}

void Holdout::append_parts(int x, int y, std::vector<Part> &parts) const {
    if (!ldi_.windows.data.intersects(Imath::V2i(x, y))) return;
    for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(Imath::V2i(x, y))))
        parts.push_back(
            {ldi_.z[i], float(back_at(ldi_, i)), std::max(0.0f, 1 - float(alpha_at(ldi_, alpha_, i)))});
}

std::size_t Holdout::parts_in(const Imath::Box2i &pixels) const {
    const Imath::Box2i &data = ldi_.windows.data;
    const int left = std::max(pixels.min.x, data.min.x), right = std::min(pixels.max.x, data.max.x);
    std::size_t count = 0;
    for (int y = std::max(pixels.min.y, data.min.y); left <= right && y <= std::min(pixels.max.y, data.max.y);
         ++y)
        count += ldi_.begin[ldi_.windows.index(Imath::V2i(right, y)) + 1] -
                 ldi_.begin[ldi_.windows.index(Imath::V2i(left, y))];
    return count;
}

namespace {

Image flatten_by_alpha(const Ldi &ldi, const Holdout &holdout) {
    Image out = flatten(ldi); // provides the ids
    const Imath::Box2i &data = ldi.windows.data;
    const std::size_t alpha = ldi.alpha();
    const std::vector<Matte> mattes = find_mattes(ldi.channels);
    parallel_for(std::size_t(ldi.windows.height()), [&](std::size_t row) {
        std::vector<double> sums(ldi.channels.size());
        MatteSum matte_sums(mattes);
        const int y = data.min.y + int(row);
        for (int x = data.min.x; x <= data.max.x; ++x) {
            const std::size_t pixel = ldi.windows.index(Imath::V2i(x, y));
            std::ranges::fill(sums, 0.0);
            for_shares(ldi, alpha, ldi.pixel(pixel), [&](std::uint64_t i, double transmittance) {
                if (!(transmittance > 0)) return;
                const double share = transmittance * holdout.passes(x, y, ldi.z[i]);
                for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += share * ldi.values[k][i];
                matte_sums.add(share, [&](std::size_t k) { return ldi.values[k][i]; });
            });
            for (std::size_t k = 0; k < sums.size(); ++k)
                if (!holds_ids(ldi.channels[k]))
                    out.values[k * out.windows.pixels() + pixel] = float(sums[k]);
            matte_sums.take(
                [&](std::size_t k, float value) { out.values[k * out.windows.pixels() + pixel] = value; });
        }
    });
    return out;
}

} // namespace

Image flatten_held_out(const Ldi &ldi, const Holdout &holdout) {
    return composited(ldi, [&](const Ldi &one) { return flatten_by_alpha(one, holdout); });
}

} // namespace sparselens
