// dof-finish: combines a gathered picture and a few rays through the same lens into one picture that is nearer to the
// truth.
#include "base/error.h"
#include "chain/colours.h"
#include "chain/notices.h"
#include "finish/ask_rays.h"
#include "finish/finish_picture.h"
#include "harness/tool.h"
#include "io/exr/exr_flat.h"
#include "io/exr/exr_header.h"
#include "io/files/file_stream.h"
#include "options/finish_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

using namespace sparselens;

namespace {

// With linear colours.
FlatFile read(const std::string &path, const FinishCommand &options, const ToolContext &tool) {
    FlatFile file = read_flat_exr(path);
    notify_reading(tool.notify(), path, file.notes, file.warnings);
    file.header = to_linear(tool.notify(), options.colour, path, file.header, file.image);
    return file;
}

// The file of a word FILE@X,Y, and where the corner of a picture lies that was cropped to a rectangle.
std::pair<std::string, std::optional<Imath::V2i>> place_of(const std::string &word) {
    const std::size_t end = word.rfind('@');
    Imath::V2i at;
    int read = 0;
    if (end == std::string::npos || std::sscanf(word.c_str() + end, "@%d,%d%n", &at.x, &at.y, &read) != 2 ||
        end + std::size_t(read) != word.size())
        return {word, {}};
    return {word.substr(0, end), at};
}

// A render, with colours in the space of the gathered picture.
FlatFile read_render(const std::string &word, const FlatFile &gathered, const FinishCommand &options,
                     const ToolContext &tool) {
    const auto [path, place] = place_of(word);
    FlatFile file = read(path, options, tool);
    Windows &windows = file.image.windows;
    if (place) {
        const Imath::V2i by = *place - windows.display.min;
        windows.data = {windows.data.min + by, windows.data.max + by};
        windows.display = gathered.image.windows.display;
    }
    to_space_of(tool.notify(), options.colour, {gathered.header, options.gathered}, {file.header, path},
                file.image);
    return file;
}

// The sample counts that the headers state. If one header states none, all renders count the same.
std::vector<double> stated_samples(const FinishCommand &options, const ToolContext &tool) {
    std::vector<double> samples;
    for (const std::string &path : options.renders)
        if (const auto stated =
                is_read_once(path) ? std::nullopt : render_samples(read_flat_header(place_of(path).first)))
            samples.push_back(*stated);
    if (samples.size() == options.renders.size()) return samples;
    tool.say("the renders do not say how many samples they have: all count the same");
    return std::vector<double>(options.renders.size(), 1);
}

// Puts the colours of Cycles' layer Noisy Image in the place of the denoised ones; false if it has none.
bool take_noisy(Image &image) {
    for (const std::string name : rgb_names) {
        const auto noisy = std::ranges::find_if(image.channels, [&](const Channel &channel) {
            return channel.name.ends_with("Noisy Image." + name);
        });
        const std::size_t denoised = find_channel(image.channels, name);
        if (noisy == image.channels.end() || denoised == npos) return false;
        std::ranges::copy(image.plane(std::size_t(noisy - image.channels.begin())),
                          image.plane(denoised).begin());
    }
    return true;
}

// Adds the renders one after the other, so that only their sum stays in memory. `add` is TwoHalves::add or add_noisy.
// Sets `have_noisy` if a file has noisy colours beside denoised ones.
TwoHalves added_up(const std::vector<std::string> &paths, const std::vector<double> &samples,
                   const FlatFile &gathered, const FinishCommand &options, const ToolContext &tool,
                   void (TwoHalves::*add)(const Render &), bool *have_noisy = nullptr) {
    TwoHalves halves(gathered.image);
    for (std::size_t k = 0; k < paths.size(); ++k) {
        FlatFile file = read_render(paths[k], gathered, options, tool);
        notify_other_lens(tool.notify(), gathered.header, file.header, paths[k]);
        if (add == &TwoHalves::add_noisy && take_noisy(file.image) && have_noisy) *have_noisy = true;
        (halves.*add)({paths[k], std::move(file.image), samples[k]});
    }
    return halves;
}

// The gathered pictures and renders of the frames before and after, as far as they exist.
std::vector<std::vector<std::string>> names_around(const FinishCommand &options, const ToolContext &tool) {
    std::vector<std::vector<std::string>> frames;
    for (int by = -options.neighbours; by <= options.neighbours; ++by) {
        if (by == 0) continue;
        std::vector<std::string> names{options.gathered};
        names.insert(names.end(), options.renders.begin(), options.renders.end());
        for (std::string &name : names) {
            const std::string here = std::exchange(name, tool.other_frame(name, by));
            if (name == here)
                throw UsageError(
                    fmt::format("--neighbours: {} is the same for all frames: give a sequence, such as "
                                "name.####.exr, and --frames",
                                here));
        }
        if (std::ranges::all_of(names, [](const std::string &name) { return std::filesystem::exists(name); }))
            frames.push_back(std::move(names));
    }
    return frames;
}

std::vector<FrameAround> read_around(const FinishCommand &options, const std::vector<double> &samples,
                                     const FlatFile &gathered, const ToolContext &tool) {
    std::vector<FrameAround> around;
    for (std::vector<std::string> &names : names_around(options, tool)) {
        FlatFile file = read_render(names[0], gathered, options, tool);
        if (file.image.windows.display != gathered.image.windows.display)
            throw Error(names[0] + ": its size differs from that of " + options.gathered);
        names.erase(names.begin());
        around.push_back({std::move(file.image),
                          added_up(names, samples, gathered, options, tool, &TwoHalves::add_noisy)});
    }
    tool.say(fmt::format("frames around: {}", around.size()));
    return around;
}

// The same value in R, G and B, so that every program shows it as grey.
Image map_of(const Values &values, const Windows &windows) {
    Image image(windows, {{"R", PixelType::half}, {"G", PixelType::half}, {"B", PixelType::half}});
    for (std::size_t c = 0; c < 3; ++c) std::ranges::copy(values, image.plane(c).begin());
    return image;
}

Image shown(FinishedPicture finished, ShowFinished show) {
    if (show == ShowFinished::picture) return std::move(finished.image);
    if (show == ShowFinished::trust) return map_of(finished.kept, finished.image.windows);
    for (float &e : finished.error.map) e = std::sqrt(e);
    return map_of(finished.error.map, finished.image.windows);
}

// Tells people, and returns what --stats writes.
Stats say_error(const FinishCommand &options, const FinishedPicture &finished, const ToolContext &tool) {
    const ErrorEstimate &error = finished.error;
    const auto known = decibels(error);
    Stats stats{{"estimated_mse", error.mean}, {"estimated_mse_deviation", error.standard_deviation}};
    stats["estimated_psnr"] = known ? Stats(*known) : Stats(nullptr);
    double kept = 0;
    for (const float share : finished.kept) kept += double(share);
    stats["kept"] = kept / double(finished.kept.size());
    tool.say(known ? fmt::format("estimated error: {:.2f} dB", *known)
                   : std::string("these renders cannot tell the error: give more samples"));
    if (!options.goal) return stats;
    const auto times = times_the_rays(error, finished.samples.mean, *options.goal);
    stats["times_the_rays"] = times ? Stats(*times) : Stats(nullptr);
    const std::string told = !times         ? "these renders cannot tell; give more samples"
                             : *times <= 1  ? "reached"
                             : *times > 100 ? "more than 100 times the rays"
                                            : fmt::format("about {:.1f} times the rays", *times);
    fmt::print(stderr, "{}: {:g} dB: {}\n", tool.tool_name, *options.goal, told);
    return stats;
}

// Writes the mask, prints the rectangles, and adds them to the statistics.
void ask(const FinishCommand &options, const FinishedPicture &finished, const Imf::Header &header,
         Stats &stats) {
    const double there = finished.samples.mean[0] + finished.samples.mean[1];
    if (options.rays > 0 && options.rays <= there)
        throw UsageError(fmt::format("--rays {:g}: the renders have {:g} already", options.rays, there));
    const Windows &windows = finished.image.windows;
    const AskedRays asked = ask_rays(finished.error, finished.samples, windows.grid(), finished.part,
                                     options.rays, std::pow(10, -options.goal.value_or(0) / 10));
    Image mask(windows, {{"samples", PixelType::float32}});
    std::ranges::copy(asked.more, mask.plane(0).begin());
    write_flat_exr(options.ask, mask, header, options.compression);
    for (const auto &[box, samples] : asked.rectangles) {
        const Imath::V2i size = box.max - box.min + Imath::V2i(1);
        fmt::print(options.output == "-" ? stderr : stdout, "{},{},{},{} {}\n", box.min.x, box.min.y, size.x,
                   size.y, samples);
        stats["ask"].push_back({box.min.x, box.min.y, size.x, size.y, samples});
    }
}

void run(const FinishCommand &options, const ToolContext &tool) {
    if (options.renders.size() < 2)
        throw UsageError("the noise of a single render is unknown: render the same picture again with "
                         "another seed, and give both");
    FlatFile file = read(options.gathered, options, tool);
    const std::vector<double> samples =
        options.samples.empty() ? stated_samples(options, tool) : options.samples;
    bool have_noisy = false;
    PictureToFinish picture{
        {}, added_up(options.renders, samples, file, options, tool, &TwoHalves::add_noisy, &have_noisy)};
    const auto &denoised = options.denoised.empty() && have_noisy ? options.renders : options.denoised;
    if (!denoised.empty())
        picture.denoised.push_back(added_up(denoised, samples, file, options, tool, &TwoHalves::add));
    for (const std::string &path : options.others)
        picture.others.push_back(read_render(path, file, options, tool).image);
    if (options.neighbours > 0) picture.around = read_around(options, samples, file, tool);
    picture.gathered = std::move(file.image);
    if (picture.rays.missing() > 0)
        warn(tool,
             fmt::format(
                 "{} pixels of the renders are missing, not finite or beyond 1e8: they stay as gathered",
                 picture.rays.missing()));
    FinishedPicture finished = finish_picture(std::move(picture), *tool.progress);
    for (const std::string &text : finished.warnings) warn(tool, text);
    if (!finished.as_gathered.empty())
        tool.say(fmt::format("stay as gathered, because a render lacks them: {}",
                             fmt::join(finished.as_gathered, ", ")));
    append_history(file.header, tool, options.history);
    Stats stats = say_error(options, finished, tool);
    if (!options.ask.empty()) ask(options, finished, file.header, stats);
    write_picture(tool.notify(), options.colour, options.output,
                  in_type(shown(std::move(finished), options.show), options.type), file.header,
                  options.compression);
    write_stats(tool, stats);
}

} // namespace

int main(int argc, char **argv) {
    return run_frames("dof-finish", "Corrects a gathered picture by a few rays through the same lens", argc,
                      argv, [](CLI::App &app) {
                          const auto options = std::make_shared<FinishCommand>();
                          add_finish_options(app, *options);
                          return Job{[options](const ToolContext &tool) { run(*options, tool); }};
                      });
}
