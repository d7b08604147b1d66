// Other programs as child processes: no shell, so file names need no quoting.
#pragma once

#include <string>
#include <vector>

namespace sparselens::lab {

struct ProcessRun {
    double seconds = 0; // wall time from start to end
    double peak_mb = 0; // largest memory it had resident, MiB
};

// Runs command[0] with the other words as arguments in `folder` and waits for its end. Its standard input is
// empty, what it writes to standard output is dropped. The peak includes what the caller itself has resident when
// it starts the child (the kernel counts so), so callers keep small while they measure.
// Error, with the command and the last line of its standard error, where it cannot start or does not exit with 0.
ProcessRun run_process(const std::vector<std::string> &command, const std::string &folder);

// The command as one would type it, for messages and records.
std::string command_line(const std::vector<std::string> &command);

} // namespace sparselens::lab
