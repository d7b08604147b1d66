#include "viewing/sequence.h"

#include "base/matte.h"
#include "base/memory.h"
#include "chain/channels.h"
#include "chain/notices.h"
#include "chain/parameters.h"
#include "chain/take_moments.h"
#include "harness/process.h"
#include "harness/progress_lines.h"
#include "io/moment_files.h"
#include "lens/thin_lens.h"
#include "options/match_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

namespace sparselens {

namespace {

constexpr const char *shown_channels = "rgba";

// Identifies how a file is read: its name and the focal length of the picture, which turns ray lengths into planar
// depths.
std::string name_of(const GatherCommand &options) {
    if (options.depth.meaning != DepthMeaning::distance) return options.input;
    return fmt::format("{}:{}:{}", options.input, options.lens.focal_length_mm.value_or(0),
                       options.lens.sensor_width_mm.value_or(0));
}

std::vector<std::string> names_of(const std::vector<GatherCommand> &frames) {
    std::vector<std::string> names;
    for (const GatherCommand &frame : frames) names.push_back(name_of(frame));
    return names;
}

// Reads a file with the options of the first frame that has its name.
FrameCache::Read reader_of(const std::vector<GatherCommand> &frames, const ToolContext &tool) {
    return [frames, &tool, all = std::make_shared<LdiCache>(true)](const std::string &name) {
        const GatherCommand &options = *std::ranges::find(frames, name, name_of);
        LdiCache alone;
        LdiCache &cache = frames.size() > 1 ? *all : alone;
        OpenedLdi &in = cache.load(middle_moment(options), tool.notify());
        in.flicker = 0; // frames are read in any order
        return loaded_frame(std::move(in), options.windows, options.colour);
    };
}

constexpr auto is_of_no_frame = [](const auto &of, const auto &) { return of.frame.expired(); };

} // namespace

Sequence::Sequence(const std::vector<GatherCommand> &frames, const ToolContext &tool)
    : frames_(names_of(frames), memory_for_frames(tool.max_memory), reader_of(frames, tool)) {
    frame(frames.front());
}

FrameCache::Held Sequence::frame(const GatherCommand &options) { return frames_.at(name_of(options)); }

GatherWindows Sequence::small(const FrameCache::Held &frame, const WindowOptions &options) {
    small_.drop_if(is_of_no_frame);
    const CachedProxy &made = small_.get({frame, options.proxy}, [&](const OfFrame &) {
        GatherWindows windows = gather_windows(options, frame->unpacked());
        const Ldi ldi = *std::exchange(windows.changed, {});
        PackedRows rows(ldi.windows);
        rows.append(ldi);
        return CachedProxy{std::move(rows), std::move(windows)};
    });
    GatherWindows windows = made.windows;
    windows.changed = all_rows(made.ldi);
    return windows;
}

const Ldi *Sequence::holdout(const GatherCommand &options, const FrameCache::Held &frame) {
    if (options.holdout.empty()) return nullptr;
    holdouts_.drop_if(is_of_no_frame);
    return &holdouts_.get({frame, options.windows.proxy, options.holdout},
                          [&](const OfFrame &) { return open_holdout(middle_moment(options), frame->in); });
}

SequencePicture Sequence::taken(const GatherCommand &options, const ToolContext &tool, Progress &progress,
                                const TileWatch *watch) {
    const FrameCache::Held of = frame(options);
    SequencePicture out;
    out.depths = of->depths;
    const Notify notify = [&](const Notice &notice) {
        if (notice.kind == NoticeKind::on_device) out.device = std::get<std::string>(notice.values.front());
        if (level_of(notice) == NoticeLevel::note)
            tool.say(words_of(notice));
        else
            out.warnings.push_back(with_options(words_of(notice)));
    };
    PictureRequest request = options;
    request.lens.focus_distance = of->camera(options).focus_distance;
    request.focus_pixel.reset();
    request.channels = shown_channels;
    const PictureWork work{progress, notify, &device_, watch, &looks_};
    if (names_moments(options.input) && options.windows.proxy == 1) {
        LdiCache cache;
        static_cast<TakenPicture &>(out) = take_moments(cache, false, request, work);
        return out;
    }
    request.shutter_curve.clear();
    request.rolling_shutter = 1;
    request.picture.holdout = holdout(options, of);
    request.holdout.clear();
    if (options.windows.proxy > 1) {
        static_cast<TakenPicture &>(out) = take_picture(of->in, small(of, options.windows), request, work);
    } else {
        give_back_memory(); // held by drafts
        static_cast<TakenPicture &>(out) = take_picture(of->unpacked(), request, work);
    }
    return out;
}

ShownPixels Sequence::displayed(Image image, double exposure, const LoadedFrame &frame) {
    image = chosen_channels(std::move(image), shown_channels);
    const auto gain = float(std::exp2(exposure));
    if (exposure != 0)
        for (std::size_t k = 0; k < image.channels.size(); ++k)
            if (image.channels[k].name != "A")
                for (float &value : image.plane(k)) value *= gain;
    transform_colours(frame.to_display, image);
    return shown_pixels(frame.in.name, image);
}

using Json = nlohmann::json;

namespace {

constexpr double sharp_px = 1; // as in --show focus
constexpr std::size_t most_objects = 65535;

// Calls visit(name) for the objects of a sample, for each matte by descending coverage.
template <typename Visit>
void for_each_object(const Ldi &ldi, std::span<const Matte> mattes, std::uint64_t sample,
                     const ObjectNames &names, const Visit &visit) {
    for (const Matte &matte : mattes)
        for (const Matte::Rank &rank : matte.ranks) {
            if (!(ldi.values[rank.coverage][sample] > 0)) continue;
            const auto found = names.find(std::bit_cast<std::uint32_t>(ldi.values[rank.id][sample]));
            if (found != names.end()) visit(found->second);
        }
}

Json objects_of(const Ldi &ldi, std::uint64_t sample, const ObjectNames &names) {
    Json objects = Json::array();
    for_each_object(ldi, find_mattes(ldi.channels), sample, names,
                    [&](const std::string &name) { objects.push_back(name); });
    return objects;
}

// The first object's name; empty if there is none.
std::string object_of(const Ldi &ldi, std::span<const Matte> mattes, std::uint64_t sample,
                      const ObjectNames &names) {
    std::string first;
    for_each_object(ldi, mattes, sample, names, [&](const std::string &name) {
        if (first.empty()) first = name;
    });
    return first;
}

// The shortest number that is this float, as people write it: 2.2, not 2.2000000476837158.
Json short_number(float value) {
    return std::isfinite(value) ? Json::parse(fmt::format("{}", value)) : Json("inf");
}

} // namespace

Json lens_facts(const SequencePicture &picture) {
    const ThinLens &lens = picture.lens;
    const SharpRange sharp = sharp_range(lens, sharp_px);
    const double largest = std::max(std::abs(circle_of_confusion(lens, picture.depths.nearest)),
                                    std::abs(circle_of_confusion(lens, picture.depths.farthest)));
    Json facts{{"focus", finite_json(lens.focus)},
               {"radius", lens.radius},
               {"near", finite_json(sharp.near)},
               {"far", finite_json(sharp.far)},
               {"hyperfocal", finite_json(sharp.hyperfocal)},
               {"largest_coc", finite_json(largest)},
               {"warnings", picture.warnings}};
    if (picture.camera.fstop) facts["fstop"] = finite_json(*picture.camera.fstop);
    if (picture.camera.metres_per_unit) facts["metres_per_unit"] = *picture.camera.metres_per_unit;
    return facts;
}

Json look_controls(const Presets &lenses) {
    Json all = Json::array();
    for (const Parameter *row : picture_parameters()) {
        const PageControl &control = row->control;
        const bool of_file = row->form == ParameterForm::file;
        if (*control.label == '\0' || (of_file && lenses.empty())) continue;
        std::vector<std::string> words = row->words;
        if (row->form == ParameterForm::flag) words.push_back("on");
        for (const auto &lens : lenses)
            if (of_file) words.push_back(lens.first);
        const char *kind = row->form == ParameterForm::number ? "number"
                           : row->form == ParameterForm::pair ? "pair"
                                                              : "choice";
        all.push_back({{"name", row->name},
                       {"label", control.label},
                       {"help", with_options(row->help)},
                       {"keyable", row->keyable},
                       {"control", kind},
                       {"words", words},
                       {"low", control.low},
                       {"high", control.high},
                       {"usual", control.usual},
                       {"whole_from", control.whole_from}});
    }
    return all;
}

ObjectMap object_map(const LoadedFrame &frame) {
    struct Object {
        std::size_t number;
        DepthExtent depths;
    };
    std::map<std::string, Object> objects;
    const std::vector<Matte> mattes = find_mattes(frame.in.ldi.channels);
    const Windows &windows = frame.in.ldi.windows;
    const Imath::Box2i box = reduced(windows.display, frame.across);
    ObjectMap map;
    const auto add = [&](const Ldi &ldi, const Imath::V2i &at) {
        const SampleRange samples = ldi.pixel(ldi.windows.index(at));
        const std::string name = samples.empty() ? "" : object_of(ldi, mattes, samples.front(), frame.names);
        if (name.empty() || (objects.size() == most_objects && !objects.contains(name)))
            return std::size_t{0};
        const double z = double(ldi.z[samples.front()]);
        Object &object = objects.try_emplace(name, Object{objects.size() + 1, {z, z}}).first->second;
        object.depths = {std::min(object.depths.nearest, z), std::max(object.depths.farthest, z)};
        return object.number;
    };
    for (int y = box.min.y; y <= box.max.y; ++y) {
        std::optional<Ldi> row;
        for (int x = box.min.x; x <= box.max.x; ++x) {
            const Imath::V2i at = middle_subpixel({x, y}, frame.across);
            const bool there = windows.data.intersects(at);
            if (there && !row) row = frame.row(at.y);
            const std::size_t number = there ? add(*row, at) : 0;
            map.numbers.push_back(std::uint8_t(number & 255));
            map.numbers.push_back(std::uint8_t(number >> 8 & 255));
        }
    }
    map.said["objects"] = Json::array();
    for (std::size_t i = 0; i < objects.size(); ++i) map.said["objects"].push_back({});
    for (const auto &[name, object] : objects) {
        const FocusFor sharp = focus_for(object.depths.nearest, object.depths.farthest);
        map.said["objects"][object.number - 1] = {{"name", name},
                                                  {"focus", finite_json(sharp.focus)},
                                                  {"hyperfocal", finite_json(sharp.hyperfocal)}};
    }
    return map;
}

Json sample_facts(const LoadedFrame &frame, const ThinLens &lens, const Imath::V2i &pixel) {
    Json samples = Json::array();
    if (!reduced(frame.in.ldi.windows.data, frame.across).intersects(pixel))
        return samples; // however far away
    const Imath::V2i at = middle_subpixel(pixel, frame.across);
    if (!frame.in.ldi.windows.data.intersects(at)) return samples;
    const Ldi ldi = frame.row(at.y);
    const auto rgb = find_rgb(ldi.channels);
    const std::size_t alpha = ldi.alpha();
    for (const std::uint64_t i : ldi.pixel(ldi.windows.index(at))) {
        const float z = ldi.z[i], seen_at = float(ldi.coc_z(i));
        Json colour = Json::array();
        for (const std::size_t k : rgb) colour.emplace_back(finite_json(double(ldi.values[k][i])));
        Json sample{{"z", short_number(z)},
                    {"alpha", alpha == npos ? 1.0 : double(ldi.values[alpha][i])},
                    {"coc", finite_json(circle_of_confusion(lens, double(seen_at)))},
                    {"rgb", colour},
                    {"objects", objects_of(ldi, i, frame.names)}};
        if (seen_at != z) sample["image"] = short_number(seen_at); // depth of the image
        samples.push_back(sample);
    }
    return samples;
}

} // namespace sparselens
