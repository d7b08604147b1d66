// dof-match: finds the focus distance and the f-stop of a filmed plate.
#include "base/error.h"
#include "chain/file_notices.h"
#include "chain/match_frames.h"
#include "harness/commands/frames.h"
#include "harness/stats.h"
#include "harness/tool.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_flat.h"
#include "io/files/text_file.h"
#include "measure/text_table.h"
#include "options/match_json.h"
#include "options/match_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <vector>

using namespace sparselens;

namespace {

// The names of the files of one frame.
struct FrameFiles {
    std::optional<int> number;
    std::string ldi, plate, show;
};

std::vector<FrameFiles> files_of(const MatchCommand &options) {
    std::vector<std::string> words{options.plate, options.input, options.show};
    if (!options.frames.empty()) words.insert(words.end(), {"--frames", options.frames});
    const FrameCommands frames(words);
    std::vector<FrameFiles> files;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::vector<std::string> names = frames.words(i);
        files.push_back({frames.is_range() ? std::optional(frames.number(i)) : std::nullopt, names[1],
                         names[0], names[2]});
    }
    return files;
}

void write_shown(const std::string &path, const Image &image) {
    if (path.empty()) return;
    if (is_shown_picture(path))
        write_shown_picture(path, image);
    else
        write_flat_exr(path, image, {});
}

// Matches the frames one after the other. Writes the pictures of their fits.
MatchedFrames match_frames(const std::vector<FrameFiles> &files, const MatchCommand &options,
                           const ToolContext &tool) {
    MatchRequest by = options.match;
    by.lens = options.lens;
    FrameMatcher matcher(by);
    LdiCache cache;
    for (const FrameFiles &frame : files) {
        if (frame.number) tool.say(fmt::format("frame {}", *frame.number));
        LdiRequest request = options;
        request.input = frame.ldi;
        const OpenedLdi &in = cache.load(request, tool.tell());
        const FlatFile plate = read_flat_exr(frame.plate);
        tell_reading(tool.tell(), frame.plate, plate.notes, plate.warnings);
        write_shown(frame.show, matcher.match(in, plate.image, frame.plate, *tool.progress));
    }
    return matcher.smooth();
}

using Json = nlohmann::ordered_json;

int key_of(const FrameFiles &files) { return files.number.value_or(1); }

// The keys that options read (harness/commands/keys.h), and the intervals.
Json keys_of(const std::vector<FrameFiles> &files, const std::vector<MatchedLens> &lenses) {
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

void print(const std::string &text) {
    if (std::fputs(text.c_str(), stdout) == EOF || std::fflush(stdout) != 0)
        throw Error("standard output: cannot write");
}

void run(const MatchCommand &options, const ToolContext &tool) {
    const std::vector<FrameFiles> files = files_of(options);
    const auto &[lenses, warnings] = match_frames(files, options, tool);
    for (const std::string &text : warnings) warn(tool, text);
    for (std::size_t i = 0; i < files.size(); ++i) {
        ToolContext of_frame;
        of_frame.tool_name = tool.tool_name;
        of_frame.stats = options.stats;
        of_frame.frame = files[i].number;
        write_stats(of_frame, as_json(lenses[i]));
    }
    Json lines;
    for (std::size_t i = 0; i < files.size(); ++i) {
        lines.push_back({{"frame", key_of(files[i])}});
        lines.back().update(as_json(lenses[i]));
    }
    if (!options.output.empty()) write_text_file(options.output, keys_of(files, lenses).dump(1) + '\n');
    print(options.json ? lines.dump(1) + '\n' : table_of(files, lenses));
}

} // namespace

int main(int argc, char **argv) {
    CLI::App app("Finds the focus distance and the f-stop at which a shot is blurred as its filmed plate",
                 "dof-match");
    MatchCommand options;
    add_match_options(app, options);
    return run_tool(app, argc, argv, [&](const ToolContext &tool) { run(options, tool); });
}
