// dof-match: finds the focus distance and the f-stop of a filmed plate.
#include "base/error.h"
#include "chain/colours.h"
#include "chain/match_lens.h"
#include "chain/notices.h"
#include "harness/commands/frames.h"
#include "harness/tool.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_flat.h"
#include "io/files/text_file.h"
#include "measure/figures_text.h"
#include "options/match_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

using namespace sparselens;

namespace {

// The names of the files of one frame.
struct FrameFiles {
    FrameCount count;
    std::string ldi, plate, show;
};

std::vector<FrameFiles> files_of(const MatchCommand &options, const ToolContext &tool) {
    std::vector<std::string> words{options.plate, options.input, options.show};
    if (!options.frames.empty()) words.insert(words.end(), {"--frames", options.frames});
    const FrameCommands frames(words);
    for (const std::string &text : frames.warnings()) warn(tool, text);
    std::vector<FrameFiles> files;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::vector<std::string> names = frames.words(i);
        const auto number = frames.is_range() ? std::optional(frames.number(i)) : std::nullopt;
        files.push_back({{i, frames.size(), number}, names[1], names[0], names[2]});
    }
    return files;
}

// The LDIs and the plates of the frames.
class Sequence {
public:
    Sequence(const MatchCommand &options, const ToolContext &tool) : options_(options), tool_(tool) {}

    const OpenedLdi &ldi(const FrameFiles &frame) {
        if (frame.count.number) tool_.say(fmt::format("frame {}", *frame.count.number));
        LdiRequest request = options_;
        request.input = frame.ldi;
        return cache_.load(request, tool_.notify());
    }
    std::unique_ptr<Progress> progress(const FrameFiles &frame) const {
        return progress_of(options_.progress, tool_.tool_name, frame.count);
    }
    Image plate(const FrameFiles &frame) {
        if (is_shown_picture(frame.plate)) {
            Image image = read_shown_picture(frame.plate).image;
            if (!holds_linear_light(frame.plate)) to_linear(tool_.notify(), {}, frame.plate, {}, image);
            return image;
        }
        FlatFile plate = read_flat_exr(frame.plate);
        notify_reading(tool_.notify(), frame.plate, plate.notes, plate.warnings);
        return std::move(plate.image);
    }

private:
    const MatchCommand &options_;
    const ToolContext &tool_;
    LdiCache cache_{true};
};

// The shape of the lens, from the first frame that tells it.
std::optional<MatchedShape> find_shape(Sequence &shot, const std::vector<FrameFiles> &files,
                                       const MatchRequest &request, const ToolContext &tool) {
    for (const FrameFiles &frame : files) {
        const OpenedLdi &in = shot.ldi(frame);
        if (const auto shape =
                match_shape(in, shot.plate(frame), frame.plate, request, *shot.progress(frame)))
            return shape;
    }
    warn(tool, "the plates do not show the shape of the lens: it needs lamps or edges that are out of focus "
               "by 6 pixels and more");
    return {};
}

// Matches the frames one after the other. Writes the pictures of their fits.
MatchedFrames match_frames(Sequence &shot, const std::vector<FrameFiles> &files,
                           const MatchRequest &request) {
    FrameMatcher matcher(request);
    for (const FrameFiles &frame : files) {
        const OpenedLdi &in = shot.ldi(frame);
        const Image fit = matcher.match(in, shot.plate(frame), frame.plate, *shot.progress(frame));
        if (!frame.show.empty()) write_plain(frame.show, fit);
    }
    return matcher.smooth();
}

using Json = nlohmann::ordered_json;

int key_of(const FrameFiles &files) { return files.count.number.value_or(1); }

// The keys that options read (harness/commands/keys.h), and the intervals.
Json keys_of(const std::vector<FrameFiles> &files, const std::vector<MatchedLens> &lenses,
             const std::optional<MatchedShape> &shape) {
    Json keys;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const MatchedLens &lens = lenses[i];
        const std::string frame = fmt::to_string(key_of(files[i]));
        const auto add = [&](const char *name, const MatchedValue &v) {
            keys[name][frame] = finite_json(v.value);
            keys["intervals"][name][frame] = {finite_json(v.low), finite_json(v.high)};
        };
        add("focus_distance", lens.focus_distance);
        add("lens_radius", lens.lens_radius);
        if (lens.fstop) add("fstop", *lens.fstop);
        if (!shape) continue;
        const Json values = as_json(*shape);
        for (const auto &[name, value] : values.items()) keys[name][frame] = value;
    }
    return keys;
}

std::string table_of(const std::vector<FrameFiles> &files, const std::vector<MatchedLens> &lenses) {
    const bool by_stop = lenses.front().fstop.has_value();
    std::vector<TextRow> rows{{"frame", "focus distance", "(90 %)", by_stop ? "f-stop" : "lens radius",
                               "(90 %)", "matched blocks"}};
    const auto value = [](double v) { return fmt::format("{:.4g}", v); };
    const auto range = [](const MatchedValue &v) { return fmt::format("{:.4g} to {:.4g}", v.low, v.high); };
    for (std::size_t i = 0; i < files.size(); ++i) {
        const MatchedValue &focus = lenses[i].focus_distance;
        const MatchedValue &size = lenses[i].fstop ? *lenses[i].fstop : lenses[i].lens_radius;
        rows.push_back({fmt::to_string(key_of(files[i])), value(focus.value), range(focus), value(size.value),
                        range(size), fmt::format("{:.0f} %", 100 * lenses[i].matched_share)});
    }
    return text_table(rows);
}

void run(const MatchCommand &options, const ToolContext &tool) {
    const std::vector<FrameFiles> files = files_of(options, tool);
    Sequence shot(options, tool);
    MatchRequest request = options.match;
    request.lens = options.lens;
    std::optional<MatchedShape> shape;
    if (options.shape) shape = find_shape(shot, files, request, tool);
    if (shape) request = with_shape(request, *shape);
    const auto &[lenses, warnings] = match_frames(shot, files, request);
    for (const std::string &text : warnings) warn(tool, text);
    Json lines;
    for (std::size_t i = 0; i < files.size(); ++i) {
        ToolContext of_frame;
        of_frame.tool_name = tool.tool_name;
        of_frame.stats = options.stats;
        of_frame.frame = files[i].count.number;
        write_stats(of_frame, as_json(lenses[i]));
        lines.push_back({{"frame", key_of(files[i])}});
        lines.back().update(as_json(lenses[i]));
        if (shape) lines.back()["shape"] = as_json(*shape);
    }
    if (!options.output.empty())
        write_text_file(options.output, keys_of(files, lenses, shape).dump(1) + '\n');
    print(options.json ? lines.dump(1) + '\n' : table_of(files, lenses));
    if (shape && !options.json)
        print(fmt::format("--blades {} --blade-rotation {:.0f} --squeeze {:.2f}\n", shape->blades,
                          shape->rotation, shape->squeeze));
}

} // namespace

int main(int argc, char **argv) {
    CLI::App app("Finds the focus distance and the f-stop of a filmed plate", "dof-match");
    MatchCommand options;
    add_match_options(app, options);
    return run_tool(app, argc, argv, [&](const ToolContext &tool) { run(options, tool); });
}
