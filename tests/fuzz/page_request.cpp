// Any bytes as a page's request to dof-view: parsed, and turned into the words of a command line, which name no file
// that the page could choose.
#include "viewing/page_request.h"

#include "fuzz/fuzz.h"

using namespace sparselens;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    fuzz::may_fail([&] {
        const PageRequest wanted = parse_page_request(fuzz::text_of(data, size));
        const GatherCommand command = command_of(words_with({"in.exr"}, wanted.settings));
        if (command.input != "in.exr" || command.output != "picture.png" || !command.holdout.empty() ||
            !command.looks.lens_file.empty() || !command.looks.aperture_file.empty() ||
            !command.colour.config.empty())
            __builtin_trap();
    });
    return 0;
}
