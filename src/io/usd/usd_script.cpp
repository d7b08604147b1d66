#include "io/usd/usd_script.h"

#include "base/error.h"
#include "io/files/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace sparselens {

namespace {

// Starts the program with files in memory as its three streams; returns the error of the system, or 0.
int start(const char *program, char *const *words, const MemoryFile *const (&streams)[3], pid_t &child) {
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    for (int stream = 0; stream < 3; ++stream)
        ::posix_spawn_file_actions_addopen(&actions, stream, streams[stream]->path().c_str(), O_RDWR, 0);
    const int error = ::posix_spawnp(&child, program, &actions, nullptr, words, environ);
    ::posix_spawn_file_actions_destroy(&actions);
    return error;
}

std::string last_line(std::string text) {
    while (text.ends_with('\n')) text.pop_back();
    return text.substr(text.find_last_of('\n') + 1);
}

} // namespace

std::string run_usd_script(const std::vector<std::string> &words, const std::string &given,
                           const std::string &file) {
    const char *const named = std::getenv("SPARSELENS_USD_PYTHON");
    const std::string program = named && *named ? named : "python3", option = "-c", script = usd_script();
    std::vector<char *> arguments;
    for (const std::string *word : {&program, &option, &script})
        arguments.push_back(const_cast<char *>(word->c_str()));
    for (const std::string &word : words) arguments.push_back(const_cast<char *>(word.c_str()));
    arguments.push_back(nullptr);

    const MemoryFile in(given), out, said;
    pid_t child = 0;
    if (const int error = start(program.c_str(), arguments.data(), {&in, &out, &said}, child); error != 0)
        throw Error(fmt::format("{}: cannot start {}, which reads and writes USD ({}): name a Python with "
                                "USD's library by SPARSELENS_USD_PYTHON",
                                file, program, std::strerror(error)));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) throw Error(fmt::format("{}: {}: {}", file, program, std::strerror(errno)));
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return read_bytes(out.path());
    const std::string why = last_line(read_bytes(said.path()));
    if (why.starts_with(file)) throw Error(why);
    throw Error(fmt::format("{}: {} fails{}{}", file, program, why.empty() ? "" : ": ", why));
}

} // namespace sparselens
