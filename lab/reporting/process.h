// Runs other programs as child processes, without a shell, so that file names need no quoting.
#pragma once

#include <string>
#include <vector>

namespace sparselens::lab {

struct ProcessRun {
    double seconds = 0; // wall time from start to end
    double peak_mb = 0; // largest resident memory, MiB
};

// Runs command[0] with the other words as arguments in `folder` and waits for its end. Its standard input is empty, and
// its standard output is discarded. The kernel counts the caller's resident memory at the start of the child in the
// peak, so callers should stay small while they measure. Throws Error, with the command and the last line of its
// standard error, if it cannot start or does not exit with 0.
ProcessRun run_process(const std::vector<std::string> &command, const std::string &folder);

// The command as typed (without quoting), for messages and records.
std::string command_line(const std::vector<std::string> &command);

} // namespace sparselens::lab
