// Serves the viewer to browsers on a port of this machine.
//
// Requests must come from the loopback device, name this machine, know the key (access.h) and be small (http_server.h,
// page_request.h). Refused requests get 403, malformed ones 400, and those that a newer one replaces 409.
#pragma once

#include "viewing/viewer.h"

#include <functional>
#include <string>

namespace sparselens {

// The page: the files of viewing/page, compiled in (cmake/Embed.cmake).
extern const char *const page_body;
extern const char *const page_style;
extern const char *const page_script;

// Serves until the process ends. Calls `ready` with the port. Throws Error if the port is not available.
void serve(Viewer &viewer, int port, const std::string &key, const std::function<void(int port)> &ready);

} // namespace sparselens
