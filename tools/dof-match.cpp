// dof-match: finds the focus distance and the f-stop of a filmed plate.
#include "base/error.h"
#include "chain/file_notices.h"
#include "chain/match_lens.h"
#include "harness/commands/frames.h"
#include "harness/stats.h"
#include "harness/tool.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_flat.h"
#include "io/files/text_file.h"
#include "measure/text_table.h"
#include "options/match_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
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

// Matches the frames one after the other; each begins with the lens of the one before.
class Matching {
public:
    Matching(const MatchCommand &options, const ToolContext &tool) : options_(options), tool_(tool) {}

    MatchedLens match(const FrameFiles &files) {
        LdiRequest request = options_;
        request.input = files.ldi;
        const OpenedLdi &in = cache_.load(request, tool_.tell());
        FlatFile plate = read_flat_exr(files.plate);
        tell_reading(tool_.tell(), files.plate, plate.notes, plate.warnings);
        MatchRequest by = options_.match;
        by.lens = options_.lens;
        by.near = last_ ? &*last_ : nullptr;
        MatchedLens found = match_lens(in, plate.image, files.plate, by, *tool_.progress);
        if (by.near && !found.doubt.empty()) { // look everywhere
            by.near = nullptr;
            found = match_lens(in, plate.image, files.plate, by, *tool_.progress);
        }
        write_shown(files.show, found.fit);
        found.fit = {};
        last_ = found.doubt.empty() ? std::optional(found) : std::nullopt;
        return found;
    }

private:
    const MatchCommand &options_;
    const ToolContext &tool_;
    LdiCache cache_;
    std::optional<MatchedLens> last_;
};

using Json = nlohmann::ordered_json;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json("inf"); }
Json as_json(const MatchedValue &v) {
    return {{"value", number(v.value)}, {"interval", {number(v.low), number(v.high)}}};
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

int key_of(const FrameFiles &files) { return files.number.value_or(1); }

// The keys that options read (harness/commands/keys.h), and the intervals.
Json keys_of(const std::vector<FrameFiles> &files, const std::vector<MatchedLens> &lenses) {
    Json keys;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const MatchedLens &lens = lenses[i];
        const std::string frame = fmt::to_string(key_of(files[i]));
        const auto add = [&](const char *name, const MatchedValue &v) {
            keys[name][frame] = number(v.value);
            keys["intervals"][name][frame] = {number(v.low), number(v.high)};
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

// Throws Error if fewer than half of the plates can be matched.
void check(const std::vector<FrameFiles> &files, const std::vector<MatchedLens> &lenses,
           const ToolContext &tool) {
    std::size_t failed = 0;
    for (std::size_t i = 0; i < files.size(); ++i)
        if (!lenses[i].doubt.empty()) {
            if (++failed * 2 > files.size())
                throw Error(fmt::format("{}: {}", files[i].plate, lenses[i].doubt));
            warn(tool, fmt::format("{}: {}; its values are those of its neighbours", files[i].plate,
                                   lenses[i].doubt));
        }
}

void run(const MatchCommand &options, const ToolContext &tool) {
    const std::vector<FrameFiles> files = files_of(options);
    std::vector<MatchedLens> lenses;
    Matching matching(options, tool);
    for (const FrameFiles &frame : files) {
        if (frame.number) tool.say(fmt::format("frame {}", *frame.number));
        lenses.push_back(matching.match(frame));
    }
    check(files, lenses, tool);
    if (files.size() > 1) lenses = smooth_over_frames(lenses);
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
