// Any bytes as a request to dof-view --pipe: parsed, and turned into a command line that writes no file of its choice.
#include "viewing/pipe_request.h"

#include "fuzz/fuzz.h"

using namespace sparselens;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    fuzz::may_fail([&] {
        PipeRequest request = parse_pipe_request(fuzz::text_of(data, size));
        request.source.file = "/none/in.exr"; // no file of this machine is read
        const GatherCommand command = command_of(words_of(request.source, {}), "picture.exr");
        if (command.input != "/none/in.exr" || command.output != "picture.exr" ||
            !command.depth_output.empty())
            __builtin_trap();
    });
    return 0;
}
