// Any words as a command line with the options that the tools share.
#include "chain/channels.h"
#include "fuzz/fuzz.h"
#include "harness/commands/frames.h"
#include "harness/tool.h"
#include "options/picture_options.h"
#include "options/warp_options.h"

#include <CLI/CLI.hpp>

#include <sstream>
#include <vector>

using namespace sparselens;

namespace {

struct Options {
    PictureRequest picture;
    ViewList views;
    std::optional<PixelType> type;
};

void use(const Options &options) {
    const Camera camera = camera_with_options(options.picture.lens, {});
    fuzz::may_fail([&] { resolve_lens(camera, windows_of_size(64, 48)); });
    for (const auto &[offset, file] : options.views.placed)
        fuzz::may_fail([&, &text = offset] { view_offset(text); });
    Ldi ldi;
    ldi.channels = rgba_channels();
    ldi.values.resize(4);
    fuzz::may_fail([&] { keep_channels(ldi, options.picture.channels); });
    fuzz::may_fail(
        [&] { chosen_channels(Image(windows_of_size(2, 2), rgba_channels()), options.picture.channels); });
}

} // namespace

// Line feeds separate the words.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    std::istringstream in(std::string(reinterpret_cast<const char *>(data), size));
    std::vector<std::string> words{"fuzz"};
    for (std::string word; std::getline(in, word);) words.push_back(word);
    fuzz::may_fail([&] {
        const FrameCommands frames({words.begin() + 1, words.end()});
        for (const std::size_t i : {std::size_t(0), frames.size() - 1})
            if (frames.words(i).size() != words.size() - 1) __builtin_trap();
    });
    std::vector<char *> arguments;
    for (std::string &word : words) arguments.push_back(word.data());
    Options options;
    CLI::App app("Fuzzed", "fuzz");
    add_view_list(app, options.views);
    add_parameters(app, gather_parameters(), options.picture);
    add_parameters(app, lens_parameters(), options.picture.lens);
    add_parameters(app, look_parameters(), options.picture.looks);
    add_parameters(app, window_parameters(), options.picture.windows);
    add_depth_options(app, options.picture.depth);
    add_type_option(app, options.type);
    const int code =
        run_tool(app, int(arguments.size()), arguments.data(), [&](const ToolContext &) { use(options); });
    if (code < 0 || code > 2) __builtin_trap();
    return 0;
}
