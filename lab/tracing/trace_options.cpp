#include "lab/tracing/trace_options.h"

#include "base/error.h"
#include "harness/tool.h"
#include "lab/trace/scenes.h"
#include "shutter/shutter_mean.h"
#include "view/resolve_lens.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

namespace sparselens::lab {

namespace {

constexpr int largest_side = 65536, largest_count = 1 << 20, largest_seed = 63;
constexpr int most_moments = 64; // as in Blender's script
constexpr double largest_dolly = 1e6;
constexpr std::size_t largest_picture = std::size_t(1) << 28; // pixels

// Parses the whole text as a number in [1, limit].
bool read_count(std::string_view text, int limit, int &value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && value >= 1 && value <= limit;
}

// Reads "WIDTHxHEIGHT"; false if the text has another form.
bool read_size(const std::string &text, TraceOptions &options) {
    const std::size_t x = text.find('x');
    return x != std::string::npos &&
           read_count(std::string_view(text).substr(0, x), largest_side, options.width) &&
           read_count(std::string_view(text).substr(x + 1), largest_side, options.height);
}

bool read_deep(const std::string &text, TraceOptions &options) {
    if (text == "visible" || text == "views") {
        options.deep.push_back({text == "views" ? DeepKind::views : DeepKind::visible, 0});
        return true;
    }
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    int layers = 0;
    if (colon == std::string::npos || !read_count(std::string_view(text).substr(colon + 1), 1024, layers))
        return false;
    if (kind != "peel" && kind != "strata") return false;
    options.deep.push_back({kind == "peel" ? DeepKind::peel : DeepKind::strata, layers});
    return true;
}

// Words and help of the scene table.
std::map<std::string, std::string> scene_names() {
    std::map<std::string, std::string> names;
    for (const SceneEntry &entry : scene_table()) names[entry.name] = entry.name;
    return names;
}

std::string scene_help() {
    std::string text = "Scene:";
    for (const SceneEntry &entry : scene_table()) text += fmt::format("\n{}: {}", entry.name, entry.summary);
    return text;
}

CLI::Validator even() {
    return {[](const std::string &text) {
                return (text.back() - '0') % 2 == 0 ? ""
                                                    : "must be an even number, half of it for each picture";
            },
            ""};
}

// Options for what is rendered: the scene, and which pictures of it.
void add_picture_options(CLI::App &app, TraceOptions &options) {
    app.add_option("SCENE", options.scene, scene_help())
        ->required()
        ->type_name("")
        ->check(CLI::IsMember(scene_names()));
    app.add_option("-o,--output", options.folder, "Folder for the pictures; made if missing")
        ->required()
        ->type_name("DIR");
    app.add_option("--views", options.views,
                   fmt::format("Number of views from the rim of the lens (default: {})", options.views))
        ->type_name("N")
        ->check(CLI::Range(0, largest_count));
    app.add_option("--plan", options.plan,
                   "Render only the pixels of this plan of ldi-plan, without the centre view and the views "
                   "of --views")
        ->type_name("PLAN.json");
    app.add_option(
           "--lens-views", options.lens_views,
           fmt::format("Number of views spread evenly over the whole lens (default: {})", options.lens_views))
        ->type_name("N")
        ->check(CLI::Range(0, largest_count));
    app.add_option("--spp", options.samples,
                   fmt::format("Samples of a view per pixel of the picture (default: {})", options.samples))
        ->type_name("N")
        ->check(CLI::Range(1, largest_count));
    app.add_option("--supersample", options.supersample,
                   fmt::format("Render views and deep pictures at N times the size with 1/N^2 of the samples "
                               "per pixel, so with as many rays; the reference keeps its size (default: {})",
                               options.supersample))
        ->type_name("N")
        ->check(CLI::Range(1, most_across));
    app.add_option("--reference", options.reference,
                   "Rays per pixel of a reference by distributed ray tracing (default: no reference)")
        ->type_name("SPP")
        ->check(CLI::Range(1, largest_count));
    app.add_option("--halves", options.halves,
                   "Rays per pixel of two pictures like the reference, half of them each, for dof-finish: "
                   "rays_1.exr, rays_2.exr (default: none)")
        ->type_name("N")
        ->check(CLI::Range(2, largest_count))
        ->check(even());
}

// Options for how it is rendered: the size, the light, the layers and the type of the channels.
void add_rendering_options(CLI::App &app, TraceOptions &options) {
    const std::map<std::string, Light> lights{
        {"sun", Light::sun}, {"area", Light::area}, {"albedo", Light::albedo}, {"normal", Light::normal}};
    const std::map<std::string, PixelType> types{{"half", PixelType::half}, {"float", PixelType::float32}};
    app.add_option_function<std::string>(
           "--size",
           [&options](const std::string &text) {
               if (!read_size(text, options))
                   throw CLI::ValidationError(
                       "--size", fmt::format("must be WIDTHxHEIGHT (e.g. 640x360), not '{}'", text));
           },
           fmt::format("Size of the display window, in pixels of the picture (default: {}x{})", options.width,
                       options.height))
        ->type_name("WxH");
    app.add_option(
           "--overscan", options.overscan,
           fmt::format("Pixels of the picture rendered beyond the display window on every side (default: {})",
                       options.overscan))
        ->type_name("PX")
        ->check(CLI::Range(0, largest_side));
    app.add_option(
           "--dolly", options.dolly,
           "How far the camera has moved into the scene, in scene units; the focus distance moves with "
           "it (default: 0)")
        ->type_name("D")
        ->check(CLI::Range(-largest_dolly, largest_dolly));
    app.add_flag(
        "--motion-blur", options.motion_blur,
        "Open the shutter: the reference and the views have motion blur, but depths are those of the "
        "middle of its time");
    app.add_option("--rolling-shutter", options.rolling_shutter,
                   "Part of the shutter's time for which each row is exposed in pictures with motion blur, "
                   "the top row first, the bottom row last (default: 1, all rows all the time)")
        ->type_name("D")
        ->check(CLI::Range(least_rolling_duration, 1.0));
    app.add_option("--moments", options.moments,
                   "Render the centre view and those of --views at N moments of the open shutter, without "
                   "motion blur and each with 1/N of the samples: center_0.exr, view_0_0.exr, ..., "
                   "center_1.exr, ... (default: views of the middle of its time)")
        ->type_name("N")
        ->check(CLI::Range(1, most_moments))
        ->excludes("--plan");
    app.add_option(
           "--seed", options.seed,
           fmt::format(
               "Seed of the random numbers; different seeds share no noise. N x N samples of a view are "
               "a grid, which no seed changes (default: {})",
               options.seed))
        ->type_name("N")
        ->check(CLI::Range(0, largest_seed));
    app.add_option("--light", options.light,
                   "Light of the scene. sun: parallel light; area: a square light, one shadow ray per "
                   "sample. Without light, from the same rays, for denoisers: albedo: colours; normal: X, Y "
                   "and Z of normals (default: sun)")
        ->type_name("sun|area|albedo|normal")
        ->transform(words(lights));
    app.add_option_function<std::vector<std::string>>(
           "--deep",
           [&options](const std::vector<std::string> &texts) {
               for (const std::string &text : texts)
                   if (!read_deep(text, options))
                       throw CLI::ValidationError(
                           "--deep",
                           fmt::format("must be visible, views, peel:K or strata:K (e.g. peel:3), not '{}'",
                                       text));
           },
           "Also render a deep picture from the lens centre. visible: what the samples of each pixel see, as "
           "renderers write it; views: the same from the views of --views; peel: the K nearest surfaces; "
           "strata: the scene cut into K depth intervals")
        ->type_name("visible|views|peel:K|strata:K")
        ->allow_extra_args(false);
    app.add_option("-d,--type", options.type, "Type of the colour channels (default: half)")
        ->type_name("half|float")
        ->transform(words(types));
}

} // namespace

void add_trace_options(CLI::App &app, TraceOptions &options) {
    add_picture_options(app, options);
    add_rendering_options(app, options);
    add_parameters(app, lens_parameters(), options.lens);
    add_parameters(app, look_parameters(), options.looks);
    add_examples(app,
                 {{"Render the centre view and four from the rim of the lens", "dof-trace fence -o views"},
                  {"Render a reference of 256 rays per pixel, too, in a small picture",
                   "dof-trace grass -o small --size 160x90 --reference 256"}});
}

int view_samples(const TraceOptions &options) {
    const int subpixels = options.supersample * options.supersample, moments = std::max(options.moments, 1);
    if (options.samples % (subpixels * moments) != 0)
        throw UsageError(
            fmt::format("--spp must be a multiple of {}: of the {} sub-pixels that --supersample "
                        "makes of a pixel, at {} moments",
                        subpixels * moments, subpixels, moments));
    return options.samples / (subpixels * moments);
}

RenderSettings view_settings(const TraceOptions &options, const Camera &camera, const Motion &motion) {
    TraceOptions fine = options;
    const double pixels = double(options.width) * options.height * options.supersample * options.supersample;
    if (pixels > double(largest_picture))
        throw UsageError(
            fmt::format("--size and --supersample ask for more than {} pixels", largest_picture));
    for (int *length : {&fine.width, &fine.height, &fine.overscan}) *length *= options.supersample;
    RenderSettings settings = render_settings(fine, camera, motion);
    if (options.moments > 0) settings.exposure = {};
    return settings;
}

RenderSettings render_settings(const TraceOptions &options, const Camera &camera, const Motion &motion) {
    RenderSettings settings{windows_of_size(options.width, options.height), {}, options.light};
    settings.windows.data.min -= Imath::V2i(options.overscan);
    settings.windows.data.max += Imath::V2i(options.overscan);
    if (settings.windows.pixels() > largest_picture)
        throw UsageError(fmt::format("--size and --overscan ask for more than {} pixels", largest_picture));
    settings.camera = options.dolly == 0 ? motion : displaced(motion, {0, 0, options.dolly});
    if (options.motion_blur || options.moments > 0) settings.exposure = whole_shutter;
    settings.rolling = options.rolling_shutter;
    settings.seed = std::uint32_t(options.seed);
    settings.lens = resolve_lens(camera, settings.windows);
    settings.lens.focal_px = resolve_focal_px(camera, settings.windows); // for a pinhole too
    settings.lens.focus = *camera.focus_distance;
    const LookValues looks = read_looks(options.looks, camera.fstop).values;
    settings.looks = resolve_looks(looks, camera, settings.lens, settings.windows);
    settings.highlights = highlight_gain(looks);
    return settings;
}

} // namespace sparselens::lab
