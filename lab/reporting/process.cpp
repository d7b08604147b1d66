#include "lab/reporting/process.h"

#include "base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>

namespace sparselens::lab {

namespace {

[[noreturn]] void fail(const std::vector<std::string> &command, const std::string &why) {
    std::string line = command_line(command);
    if (line.size() > 300) line = line.substr(0, 300) + "...";
    throw Error(line + ": " + why);
}

// Keeps the child's standard error in memory.
class Words {
public:
    Words() : descriptor_(memfd_create("stderr", MFD_CLOEXEC)) {
        if (descriptor_ < 0) throw Error(fmt::format("memfd_create: {}", std::strerror(errno)));
    }
    ~Words() { close(descriptor_); }
    Words(const Words &) = delete;
    Words &operator=(const Words &) = delete;

    int descriptor() const { return descriptor_; }

    std::string last_line() const {
        char text[2000];
        const off_t end = lseek(descriptor_, 0, SEEK_END);
        const off_t begin = end > off_t(sizeof text) ? end - off_t(sizeof text) : 0;
        const ssize_t size = pread(descriptor_, text, sizeof text, begin);
        std::string tail(text, size > 0 ? std::size_t(size) : 0);
        while (!tail.empty() && tail.back() == '\n') tail.pop_back();
        return tail.substr(tail.find_last_of("\r\n") + 1);
    }

private:
    int descriptor_;
};

class SpawnActions {
public:
    SpawnActions(const std::string &folder, int words) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_adddup2(&actions_, words, STDERR_FILENO);
        posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
    }
    ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
    SpawnActions(const SpawnActions &) = delete;
    SpawnActions &operator=(const SpawnActions &) = delete;

    const posix_spawn_file_actions_t *get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_;
};

} // namespace

std::string command_line(const std::vector<std::string> &command) {
    return fmt::format("{}", fmt::join(command, " "));
}

ProcessRun run_process(const std::vector<std::string> &command, const std::string &folder) {
    const Words words;
    const SpawnActions actions(folder, words.descriptor());
    std::vector<char *> arguments;
    for (const std::string &word : command) arguments.push_back(const_cast<char *>(word.c_str()));
    arguments.push_back(nullptr);

    const auto start = std::chrono::steady_clock::now();
    pid_t child = 0;
    const int error = posix_spawnp(&child, arguments[0], actions.get(), nullptr, arguments.data(), environ);
    if (error != 0) fail(command, fmt::format("cannot be started: {}", std::strerror(error)));
    int status = 0;
    rusage used{};
    while (wait4(child, &status, 0, &used) < 0)
        if (errno != EINTR) fail(command, fmt::format("wait4: {}", std::strerror(errno)));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;

    if (WIFSIGNALED(status)) fail(command, fmt::format("ended by signal {}", WTERMSIG(status)));
    if (WEXITSTATUS(status) != 0)
        fail(command, fmt::format("exit code {}: {}", WEXITSTATUS(status), words.last_line()));
    return {seconds.count(), double(used.ru_maxrss) / 1024};
}

} // namespace sparselens::lab
