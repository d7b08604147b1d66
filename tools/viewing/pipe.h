// dof-view --pipe: requests on standard input, answers on standard output, in order, each in one line; pixels in a file
// that both programs have open as descriptor 3, such as one of memfd_create().
//
// A request is a line of JSON (pipe_request.h). An answer is "STATUS BYTES TEXT": the status 200 with facts as JSON and
// the number of bytes in the file from its beginning; or, with 0 bytes and the reason as text, 400 if the request is
// impossible and 500 if it failed. The first line answers nothing and says the version. The asking program may cut the
// file off after it has read it. A request may bring pixels in the same file.
//
// It ends with its standard input, after the requests that came before, and at once if nobody reads its answers any
// more or the program that started it has ended.
#pragma once

#include "harness/tool.h"

namespace sparselens {

inline constexpr int pipe_version = 2;

#ifdef _WIN32 // which has no descriptor 3
inline constexpr bool has_pipe = false;
#else
inline constexpr bool has_pipe = true;
#endif

// Returns at the end of standard input. Throws UsageError if descriptor 3 is no file that can be written.
void answer_pipe(const ToolContext &tool);

} // namespace sparselens
