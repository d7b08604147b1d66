// dof-view: a page in a browser that shows the picture that a lens takes from a layered depth image, and changes the lens.
#include "harness/commands/frames.h"
#include "harness/examples.h"
#include "harness/process.h"
#include "harness/tool.h"
#include "options/gather_options.h"
#include "viewing/door.h"
#include "viewing/open_browser.h"
#include "viewing/server.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

using namespace sparselens;

namespace {

void add_options(CLI::App &app, ViewOptions &options) {
    add_picture_making_options(app, options.picture);
    app.add_option("--reference", options.reference, "Picture to compare with (EXR)")->type_name("FILE");
    app.add_option("--frames", options.frames,
                   "Frames of a timeline, e.g. 1-100x2 (default: the files that #### in IN stands for)")
        ->type_name("RANGE")
        ->group("Frames");
    app.add_option("--port", options.port,
                   "Port of this machine to serve at; 0: any that is free (default: 0)")
        ->type_name("N")
        ->check(CLI::Range(0, 65535));
    app.add_option("--save", options.save,
                   "Folder that the page may write pictures to (default: it writes nothing)")
        ->type_name("DIR");
    app.add_flag("--open", options.open, "Open the page in the browser");
    add_examples(app, {{"Look at an LDI: open the address that is printed in a browser", "dof-view ldi.exr"},
                       {"Look at a sequence", "dof-view shot.####.ldi.exr --frames 1-48"},
                       {"... beside the ray-traced picture, at a port of your choice",
                        "dof-view ldi.exr --reference reference.exr --port 8080"}});
}

void print_address(const std::string &address, int port) {
    fmt::print("{}\nFrom another machine: ssh -L {}:127.0.0.1:{} THIS_MACHINE, then open that address there. "
               "Ctrl-C ends.\n",
               address, port, port);
    std::fflush(stdout);
}

// dof-view, of the frames that the words describe; its options are those of the first.
int view(const std::vector<std::string> &words, const FrameCommands &frames) {
    CLI::App app("Shows the picture that a lens takes from a layered depth image (LDI) in a browser, and "
                 "changes the lens",
                 "dof-view");
    ViewOptions options;
    add_options(app, options);
    return run_tool(app, frames.words(0), [&](const ToolContext &tool) {
        options.presets = lens_presets();
        Viewer viewer(options, words, frames, tool);
        const std::string key = random_key();
        serve(viewer, options.port, key, [&](int port) {
            const std::string address = fmt::format("http://127.0.0.1:{}/?key={}", port, key);
            print_address(address, port);
            if (options.open) open_browser(address);
        });
    });
}

} // namespace

int main(int argc, char **argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    std::optional<FrameCommands> frames;
    if (const int code = exit_code_of("dof-view: ", [&] { frames.emplace(words); })) return code;
    return view(words, *frames);
}
