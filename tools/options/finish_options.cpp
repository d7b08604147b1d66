#include "options/finish_options.h"

#include "finish/tuning.h"
#include "harness/tool.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <map>

namespace sparselens {

namespace {

void check(const FinishCommand &options) {
    if (!options.ask.empty() && options.rays == 0 && !options.goal)
        throw CLI::ValidationError("--ask", "needs to know how many rays: give --rays or --goal");
    if (!options.ask.empty() && !options.ask.ends_with(".exr"))
        throw CLI::ValidationError("--ask", "must end in .exr, not '" + options.ask + "'");
    if (!options.samples.empty() && options.samples.size() != options.renders.size())
        throw CLI::ValidationError("--samples", fmt::format("{} numbers for {} renders: give one for each",
                                                            options.samples.size(), options.renders.size()));
    if (!options.denoised.empty() && options.denoised.size() != options.renders.size())
        throw CLI::ValidationError("--denoised",
                                   fmt::format("{} pictures for {} renders: denoise each render by itself",
                                               options.denoised.size(), options.renders.size()));
}

void add_input_options(CLI::App &app, FinishCommand &options) {
    app.add_option("GATHERED", options.gathered, "Picture of dof-gather (EXR); - for standard input")
        ->type_name("")
        ->required();
    app.add_option("RAYS", options.renders,
                   "Two or more renders of the picture with depth of field, with the same camera and lens "
                   "and different seeds; FILE@X,Y for one that is cropped to a rectangle and does not tell "
                   "where it lies, as Blender's are. Colours of Cycles' layer Noisy Image come before "
                   "denoised ones, which then count as --denoised")
        ->type_name("...")
        ->required();
    app.add_option("--samples", options.samples,
                   "Samples per pixel of each render, comma-separated (default: as the files say, else the "
                   "same for all)")
        ->type_name("N,N,...")
        ->delimiter(',')
        ->check(number(above_0));
    app.add_option("--denoised", options.denoised, "Denoised version of each render, in the same order")
        ->type_name("FILE...");
    app.add_option("--gathered", options.others,
                   "Another gathered picture of the same lens, for example of denoised views; used where the "
                   "renders confirm it")
        ->type_name("FILE")
        ->take_all()
        ->allow_extra_args(false);
    app.add_option("--neighbours", options.neighbours,
                   "Also use the renders of N frames before and N after, where the error of the gathered "
                   "picture stays the same; missing frames are left out (default: 0)")
        ->type_name("N")
        ->check(CLI::Range(0, 16));
}

} // namespace

void add_finish_options(CLI::App &app, FinishCommand &options) {
    add_input_options(app, options);
    app.add_option("-o,--output", options.output,
                   fmt::format("Picture to write ({}); - for standard output", picture_formats()))
        ->type_name("OUT.exr")
        ->required();
    const std::map<std::string, ShowFinished> shows{{"error", ShowFinished::error},
                                                    {"trust", ShowFinished::trust}};
    app.add_option("--show", options.show,
                   "Write a map instead of the picture. error: the estimated error of each pixel as a "
                   "display shows it, root mean square; trust: 1 where the picture stays as gathered, 0 "
                   "where the renders replace it")
        ->type_name("error|trust")
        ->transform(words(shows));
    app.add_option("--goal", options.goal, "Also print how many rays a picture of this quality (dB) takes")
        ->type_name("DB")
        ->check(number(above_0));
    CLI::Option *ask =
        app.add_option(
               "--ask", options.ask,
               "Also write how many more samples each pixel needs, and print a few rectangles to render with "
               "about as many: X,Y,WIDTH,HEIGHT SAMPLES, the samples of two renders together")
            ->type_name("MASK.exr");
    constexpr NumberRange possible{"a number above 0, of a million at most",
                                   [](double v) { return v > 0 && v <= FinishTuning::most_rays; }};
    app.add_option(
           "--rays", options.rays,
           "Mean rays per pixel for --ask, including those of the renders (default: as many as --goal takes)")
        ->type_name("N")
        ->needs(ask)
        ->check(number(possible));
    add_parameters(app, output_colour_parameters(), options.colour);
    add_type_option(app, options.type);
    add_compression_option(app, options.compression, false);
    add_history_option(app, options.history);
    add_examples(
        app, {{"Correct a gathered picture by two renders through the lens",
               "dof-finish picture.exr rays_1.exr rays_2.exr -o final.exr"},
              {"Finish a sequence with the renders of two frames before and after each frame",
               "dof-finish picture.####.exr rays_1.####.exr rays_2.####.exr -o final.####.exr --frames 1-3 "
               "--neighbours 2"},
              {"Find where more rays help most, for 80 rays per pixel on average",
               "dof-finish picture.exr rays_1.exr rays_2.exr -o draft.exr --ask mask.exr --rays 80"},
              {"See where the renders replaced the picture",
               "dof-finish picture.exr rays_1.exr rays_2.exr -o trust.exr "
               "--show trust"}});
    app.final_callback([&options] { check(options); });
}

} // namespace sparselens
