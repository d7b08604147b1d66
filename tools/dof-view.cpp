// dof-view: serves a page for the browser that shows the picture of a layered depth image through a lens, and changes
// the lens.
#include "base/error.h"
#include "base/system/system.h"
#include "harness/commands/frames.h"
#include "harness/process.h"
#include "harness/tool.h"
#include "io/files/file_stream.h"
#include "io/lens_file.h"
#include "options/gather_options.h"
#include "viewing/access.h"
#include "viewing/pipe.h"
#include "viewing/server.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

using namespace sparselens;

namespace {

// Writes a page that redirects to the address. The file is deleted a minute later, or with the temporary folder.
std::string file_that_leads_to(const std::string &address) {
    const std::string name = fmt::format("dof-view-{}.html", random_key()),
                      path = (std::filesystem::temp_directory_path() / name).string();
    const int file = system::open(path, system::Open::secret);
    if (file < 0) fail_of_system("--open", "cannot write " + path);
    write_all("--open", file, fmt::format("<meta http-equiv=\"refresh\" content=\"0;url={}\">\n", address));
    system::close(file);
    return path;
}

// Opens the page through a file that only its owner can read, because every user of the machine can see the arguments
// of a process. Throws Error if the file cannot be written or no program opens it.
void open_browser(const std::string &address) {
    const std::string file = file_that_leads_to(address);
    if (!system::show_in_browser(file)) {
        std::filesystem::remove(file);
        throw Error("--open: xdg-open is not there (Debian: xdg-utils); open " + address);
    }
    std::thread([file] {
        std::this_thread::sleep_for(std::chrono::minutes(1));
        std::error_code gone;
        std::filesystem::remove(file, gone);
    }).detach();
}

// Takes no other option of the picture, because each request names its own.
void add_pipe_option(CLI::App &app, bool &pipe) {
    CLI::Option *option = app.add_flag(
        "--pipe", pipe,
        "Serve no page, but answer requests of other programs on standard input (docs/openimageio.md)");
    for (CLI::Option *other : app.get_options())
        if (other != option && other != app.get_help_ptr()) option->excludes(other);
}

void add_options(CLI::App &app, ViewOptions &options) {
    add_picture_making_options(app, options.picture);
    app.add_option("--reference", options.reference, "Picture to compare with (EXR)")->type_name("FILE");
    app.add_option("--plate", options.plate,
                   "Filmed plate (EXR) to show behind the picture; \"match\" finds its lens like dof-match")
        ->type_name("FILE");
    app.add_option("--frames", options.frames,
                   "Frames of the timeline, e.g. 1-100x2 (default: the frames of IN on disk)")
        ->type_name("RANGE")
        ->group("Frames");
    app.add_option("--port", options.port, "Port of this machine; 0: any free port (default: 0)")
        ->type_name("N")
        ->check(CLI::Range(0, 65535));
    app.add_option("--save", options.save,
                   "Folder for pictures that the page saves (default: the page saves nothing)")
        ->type_name("DIR");
    app.add_flag("--open", options.open, "Open the page in the browser");
    if (has_pipe) add_pipe_option(app, options.pipe);
    add_examples(app, {{"Look at an LDI in a browser, at the address that is printed", "dof-view ldi.exr"},
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

// Runs dof-view on the frames that the words describe. The options are those of the first frame.
int view(const std::vector<std::string> &words, const FrameCommands &frames) {
    CLI::App app("Shows the picture that a lens takes from a layered depth image (LDI) in a browser, and "
                 "changes the lens",
                 "dof-view");
    ViewOptions options;
    add_options(app, options);
    if (std::ranges::find(words, "--pipe") != words.end()) app.get_option("IN")->required(false);
    return run_tool(app, frames.words(0), [&](const ToolContext &tool) {
        if constexpr (has_pipe)
            if (options.pipe) return answer_pipe(tool);
        options.presets = installed_lenses();
        for (const std::string &text : frames.warnings()) warn(tool, text);
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
