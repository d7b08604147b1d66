#include "viewing/pipe_service.h"

#include "base/error.h"
#include "base/system/system.h"
#include "chain/notices.h"
#include "chain/take_moments.h"
#include "harness/history.h"
#include "harness/process.h"
#include "harness/progress_lines.h"
#include "io/exr/exr_flat.h"
#include "io/lens_file.h"
#include "io/moment_files.h"
#include "options/gather_options.h"
#include "options/match_options.h"
#include "viewing/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace sparselens {

namespace {

using Json = nlohmann::json;

constexpr int most_proxy = 1024; // of dof-gather

const char *name_of(PixelType type) {
    if (type == PixelType::half) return "half";
    return type == PixelType::uint32 ? "uint" : "float";
}

// Windows and channels.
Json layout_of(const TakenPicture &picture) {
    const Imath::Box2i &data = picture.image.windows.data, &display = picture.image.windows.display;
    Json channels = Json::array();
    for (const Channel &channel : channels_in_file(picture.image, picture.header))
        channels.push_back({{"name", channel.name}, {"type", name_of(channel.type)}});
    return {{"data", {data.min.x, data.min.y, data.max.x, data.max.y}},
            {"display", {display.min.x, display.min.y, display.max.x, display.max.y}},
            {"channels", channels}};
}

std::vector<std::size_t> chosen(const std::vector<std::string> &names, const TakenPicture &picture) {
    const std::vector<Channel> there = channels_in_file(picture.image, picture.header);
    std::vector<std::size_t> all(there.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    if (names.empty()) return all;
    std::vector<std::size_t> some;
    for (const std::string &name : names) {
        const std::size_t k = find_channel(there, name);
        if (k == npos) throw UsageError("the request: the picture has no channel " + name);
        some.push_back(k);
    }
    return some;
}

} // namespace

PipeService::PipeService(const ToolContext &tool)
    : tool_(tool), presets_(installed_lenses()),
      pictures_(memory_for_frames(tool.max_memory), [](const Made &made) {
          return std::uint64_t(made.picture.image.values.size() * sizeof(float));
      }) {}

// The colours are those that the configuration of OpenColorIO gives a file of such a name.
void PipeService::take(PipeRequest &request, std::string pixels) {
    auto &settings = request.source.settings;
    if (!settings.contains("colorspace")) {
        const auto config = settings.find("colorconfig");
        settings["colorspace"] = ColourConfig(config == settings.end() ? "" : config->second)
                                     .space_of_file(request.handed->shown ? "picture.png" : "picture.exr");
    }
    request.source.file = handed_.path_of(*request.handed, std::move(pixels));
}

PipeService::Job PipeService::job_of(const PipeRequest &request) const {
    Job job;
    job.shown = request.shown;
    job.words = words_of(request.source, presets_);
    job.command = command_of(job.words, "picture.exr");
    if (request.level > 0) {
        const int proxy = job.command.windows.proxy << request.level;
        job.words = words_without(job.words, "proxy");
        job.words.insert(job.words.end(), {"--proxy", fmt::to_string(proxy)});
        job.command = command_of(job.words, "picture.exr");
    }
    for (const std::string &file : files_in(job.words))
        job.stamps[file] = system::stamp_of(file).value_or(system::FileStamp{}).state;
    return job;
}

// Forgets the LDI if one of the files has changed since they were last read.
void PipeService::forget_changed(const Job &job) {
    constexpr std::size_t most_files = 4096;
    bool changed = stamps_.size() > most_files;
    if (changed) stamps_.clear();
    for (const auto &[file, stamp] : job.stamps) {
        std::string &before = stamps_[file];
        changed = changed || (!before.empty() && before != stamp);
        before = stamp;
    }
    if (changed) cache_ = LdiCache();
}

PipeService::Made PipeService::make(const Job &job, const Make &make) {
    forget_changed(job);
    Made made;
    const Notify notify = [&](const Notice &notice) {
        if (level_of(notice) != NoticeLevel::note)
            made.warnings.push_back(InMemoryPictures::in_words(one_line(with_options(words_of(notice)))));
    };
    made.picture = make({*tool_.progress, notify, &device_});
    ToolContext gather;
    gather.command_line = command_line("dof-gather", job.words);
    append_history(made.picture.header, gather, job.command.history);
    return made;
}

void PipeService::to_stored_colours(const Job &job, Image &image, Imf::Header &header) {
    if (job.shown)
        transform_colours(output_transform(job.command.colour, header), image);
    else
        to_exr_space(job.command.colour, "an EXR picture", image, header);
}

const PipeService::Made &PipeService::described(const Job &job) {
    // The window of a shutter's picture holds those of all moments, so they have to be read.
    if (names_moments(job.command.input)) return taken(job);
    const auto describe = [&](const PictureWork &work) {
        TakenPicture picture = describe_picture(cache_, job.command, work);
        const Windows windows = picture.image.windows;
        Image pixel({windows.display, {windows.data.min, windows.data.min}, windows.pixel_aspect},
                    picture.image.channels);
        to_stored_colours(job, pixel, picture.header);
        picture.image = in_type(std::move(pixel), job.command.type);
        picture.image.windows.data = windows.data; // without values but for its first pixel
        return picture;
    };
    return descriptions_.get(job, [&](const Job &) { return make(job, describe); });
}

const PipeService::Made &PipeService::taken(const Job &job) {
    const auto take = [&](const PictureWork &work) {
        TakenPicture picture = take_moments(cache_, true, job.command, work);
        to_stored_colours(job, picture.image, picture.header);
        picture.image = in_type(std::move(picture.image), job.command.type);
        return picture;
    };
    return pictures_.get(job, [&](const Job &) { return make(job, take); });
}

PipeService::Answer PipeService::facts(const Job &job) {
    const Made &made = described(job);
    forget_changed(job);
    const Notify quiet = [](const Notice &) {};
    SequencePicture shot;
    static_cast<TakenPicture &>(shot) = made.picture;
    shot.warnings = made.warnings;
    shot.depths = depth_extent(cache_.load(middle_moment(job.command), quiet).ldi);
    Json said = lens_facts(shot);
    said.update(
        {{"nearest", finite_json(shot.depths.nearest)}, {"farthest", finite_json(shot.depths.farthest)}});
    return {std::move(said), {}};
}

// The number of sizes: each is half of the last one, the smallest has a pixel.
int PipeService::levels_of(const Job &job, const Made &made) {
    const Windows &windows = made.picture.image.windows;
    const int side = std::max(windows.width(), windows.height()), proxy = job.command.windows.proxy;
    int levels = 1;
    while (levels < most_levels && side >> levels > 0 && proxy << levels <= most_proxy) ++levels;
    return levels;
}

PipeService::Answer PipeService::header(const Job &job, const Made &made) {
    Json said = layout_of(made.picture);
    const Imath::V2i first = made.picture.image.windows.data.min;
    const bool has_values = made.picture.image.values.size() > made.picture.image.channels.size();
    Image pixel = has_values ? crop(made.picture.image, {first, first}) : made.picture.image;
    pixel.windows.data = {first, first};
    const GatherCommand &command = job.command;
    said.update({{"levels", levels_of(job, made)},
                 {"command", command_line("dof-gather", job.words)},
                 {"warnings", made.warnings}});
    return {std::move(said),
            flat_exr(command.input, pixel, made.picture.header, command.compression, command.tiles)};
}

PipeService::Answer PipeService::pixels(const Made &made, const PipeRequest &request) {
    const Imath::Box2i &data = made.picture.image.windows.data;
    const Imath::Box2i box = request.box.value_or(data);
    if (box.min.x < data.min.x || box.min.y < data.min.y || box.max.x > data.max.x || box.max.y > data.max.y)
        throw UsageError(
            fmt::format("the request: the box leaves the picture, whose pixels go from {},{} to {},{}",
                        data.min.x, data.min.y, data.max.x, data.max.y));
    Json said = layout_of(made.picture);
    said["warnings"] = made.warnings;
    return {std::move(said), stored_pixels(made.picture.image, box, chosen(request.channels, made.picture))};
}

PipeService::Answer PipeService::answer(const PipeRequest &request) {
    const Job job = job_of(request);
    switch (request.ask) {
    case Ask::facts: return facts(job);
    case Ask::header: return header(job, described(job));
    case Ask::picture:
    case Ask::tile: break;
    }
    return pixels(taken(job), request);
}

} // namespace sparselens
