// Any bytes from a connection of dof-view: parsed into as many requests as they hold, each within its limits.
#include "fuzz/fuzz.h"
#include "viewing/http_server.h"

using namespace sparselens;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    std::string received(fuzz::text_of(data, size));
    try {
        for (std::size_t before = received.size() + 1; !received.empty() && received.size() < before;) {
            before = received.size();
            const auto request = take_request(received);
            if (!request) break;
            if (request->body.size() > most_body || request->path.size() > most_head ||
                request->path[0] != '/')
                __builtin_trap();
        }
    } catch (const HttpRefusal &) {
    }
    return 0;
}
