#include "options/match_options.h"

#include "chain/parameter_rows.h"
#include "harness/process.h"
#include "harness/tool.h"
#include "options/picture_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <map>

namespace sparselens {

namespace {

void add_file_options(CLI::App &app, MatchCommand &options) {
    app.add_option("IN", options.input,
                   "LDI of the shot, any deep EXR, or a flat EXR with depth, for example of a scanned set")
        ->type_name("")
        ->required();
    app.add_option("PLATE", options.plate,
                   "Filmed plate of the same size (EXR, PNG, JPEG, DPX and others; the file rules of "
                   "OpenColorIO give the colour space); colours are not compared")
        ->type_name("")
        ->required();
    app.add_option("-o,--output", options.output,
                   "Keys to write (JSON), for --focus-distance @KEYS.json and --fstop @KEYS.json")
        ->type_name("KEYS.json");
    app.add_option(
           "--show", options.show,
           fmt::format("Also write the gathered picture beside the plate, in grey ({})", picture_formats()))
        ->type_name("PICTURE")
        ->check(output_name(OutputKind::picture));
    app.add_flag("--json", options.json, "Print JSON instead of a table");
    app.add_option("--frames", options.frames,
                   "Frames to match; file names hold #### (also #: four digits) or %04d (default: the plates "
                   "on disk)")
        ->type_name("RANGE")
        ->group("Frames");
    app.add_option("--stats", options.stats,
                   "File to which statistics are appended, one line of JSON per frame; - for stderr")
        ->type_name("FILE");
    add_progress_option(app, options.progress);
}

} // namespace

void add_match_options(CLI::App &app, MatchCommand &options) {
    options.channels = "rgba";
    add_file_options(app, options);
    app.add_option_function<std::string>(
           "--region",
           [&options](const std::string &text) {
               if (!parameter_rows::read_place({}, text, options.match.region.emplace()))
                   throw CLI::ValidationError(
                       "--region",
                       fmt::format("must be X0,Y0,X1,Y1 (left, top, right and bottom), not '{}'", text));
           },
           "Pixels to compare, in EXR coordinates, X1 and Y1 included (default: all)")
        ->type_name("X0,Y0,X1,Y1");
    const std::map<std::string, MatchFit> fits{
        {"both", MatchFit::both}, {"focus", MatchFit::focus}, {"fstop", MatchFit::fstop}};
    app.add_option("--fit", options.match.fit,
                   "Values to find; the other one comes from the file or an option (default: both)")
        ->type_name("both|focus|fstop")
        ->transform(words(fits));
    app.add_flag("--shape", options.shape,
                 "Also find the blades and the squeeze of the lens, from lamps that are out of focus");
    add_parameters(app, lens_parameters(), options.lens);
    add_parameters(app, depth_parameters(), options.depth);
    add_examples(app, {{"Find the lens of a filmed rack of focus",
                        "dof-match shot.ldi.exr plate.####.exr --region 200,100,799,439 -o keys.json"},
                       {"Find the focus alone, with the f-stop of the camera report",
                        "dof-match shot.ldi.exr plate.exr --fstop 2.8 --fit focus"}});
}

namespace {

using Json = nlohmann::ordered_json;

Json as_json(const MatchedValue &v) {
    return {{"value", finite_json(v.value)}, {"interval", {finite_json(v.low), finite_json(v.high)}}};
}

} // namespace

Json finite_json(double value) { return std::isfinite(value) ? Json(value) : Json("inf"); }

Json as_json(const MatchedShape &shape) {
    return {{"blades", shape.blades}, {"blade_rotation", shape.rotation}, {"squeeze", shape.squeeze}};
}

Json as_json(const MatchedLens &lens) {
    Json line{{"focus_distance", as_json(lens.focus_distance)}, {"lens_radius", as_json(lens.lens_radius)}};
    if (lens.fstop) line["fstop"] = as_json(*lens.fstop);
    line["softness"] = lens.softness;
    line["matched_share"] = lens.matched_share;
    line["largest_coc"] = lens.largest_coc;
    if (!lens.doubt.empty()) line["doubt"] = lens.doubt;
    return line;
}

} // namespace sparselens
