#include "base/system/system.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <thread>

namespace sparselens::system {

namespace {

// Repeats a call that a signal interrupts.
template <typename Call>
auto whole(const Call &call) {
    for (;;)
        if (const auto result = call(); result >= 0 || errno != EINTR) return result;
}

// Returns the error of the system, or 0. The words stay as they are.
int spawn(const std::vector<std::string> &words, const posix_spawn_file_actions_t *actions, pid_t &child) {
    std::vector<char *> arguments;
    for (const std::string &word : words) arguments.push_back(const_cast<char *>(word.c_str()));
    arguments.push_back(nullptr);
    return errno = ::posix_spawnp(&child, arguments[0], actions, nullptr, arguments.data(), environ);
}

} // namespace

int open(const std::string &path, Open how) {
    constexpr int flags[]{O_RDONLY, O_WRONLY, O_WRONLY | O_CREAT | O_APPEND, O_RDWR | O_CREAT | O_EXCL,
                          O_RDWR | O_CREAT | O_EXCL};
    return ::open(path.c_str(), flags[int(how)] | O_CLOEXEC, how == Open::secret ? 0600 : 0666);
}

int duplicate(int file) { return ::dup(file); }
bool close(int file) { return ::close(file) == 0; }
bool resize(int file, std::uint64_t bytes) { return ::ftruncate(file, off_t(bytes)) == 0; }
bool seek(int file, std::uint64_t position) { return ::lseek(file, off_t(position), SEEK_SET) >= 0; }

std::ptrdiff_t read(int file, char *to, std::size_t most) {
    return whole([&] { return ::read(file, to, most); });
}

std::ptrdiff_t write(int file, const char *from, std::size_t count) {
    return whole([&] { return ::write(file, from, count); });
}

std::size_t read_at(int file, char *to, std::size_t most, std::uint64_t position) {
    std::size_t got = 0;
    while (got < most) {
        const ssize_t more =
            whole([&] { return ::pread(file, to + got, most - got, off_t(position + got)); });
        if (more <= 0) break;
        got += std::size_t(more);
    }
    return got;
}

std::optional<std::uint64_t> size_of(int file) {
    struct stat info {};
    if (::fstat(file, &info) != 0 || !S_ISREG(info.st_mode)) return {};
    return std::uint64_t(info.st_size);
}

bool is_pipe(int file) {
    struct stat info {};
    return ::fstat(file, &info) == 0 && (S_ISFIFO(info.st_mode) || S_ISSOCK(info.st_mode));
}

bool is_terminal(int file) { return ::isatty(file) != 0; }

UnnamedFile::UnnamedFile()
    : number_(::memfd_create("sparselens", MFD_CLOEXEC)), path_("/proc/self/fd/" + std::to_string(number_)) {}
UnnamedFile::~UnnamedFile() { ::close(number_); }

bool may_write(const std::string &path) { return ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0; }

std::optional<FileStamp> stamp_of(const std::string &path) {
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) return {};
    const std::string identity = std::to_string(info.st_dev) + ':' + std::to_string(info.st_ino);
    std::string state = identity;
    for (const auto number : {info.st_size, info.st_mtim.tv_sec, info.st_mtim.tv_nsec, info.st_ctim.tv_nsec})
        state += ':' + std::to_string(number);
    return FileStamp{S_ISREG(info.st_mode) ? identity : "", state};
}

std::vector<std::string> own_files() {
    std::error_code unknown;
    Dl_info code{};
    ::dladdr(reinterpret_cast<const void *>(&own_files), &code);
    return {std::filesystem::read_symlink("/proc/self/exe", unknown).string(),
            std::filesystem::weakly_canonical(code.dli_fname ? code.dli_fname : "", unknown).string()};
}

int process_id() { return ::getpid(); }

std::uint64_t physical_memory() {
    return std::uint64_t(::sysconf(_SC_PHYS_PAGES)) * std::uint64_t(::sysconf(_SC_PAGESIZE));
}

void *load_library(const std::string &path) { return ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL); }
void *function_of(void *library, const char *name) { return ::dlsym(library, name); }
std::string loading_error() {
    const char *why = ::dlerror();
    return why ? why : "";
}

int run_program(const std::vector<std::string> &words, const std::vector<std::string> &streams) {
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    for (std::size_t stream = 0; stream < streams.size(); ++stream)
        ::posix_spawn_file_actions_addopen(&actions, int(stream), streams[stream].c_str(), O_RDWR, 0);
    pid_t child = 0;
    const int error = spawn(words, &actions, child);
    ::posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (error != 0 || whole([&] { return ::waitpid(child, &status, 0); }) < 0) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool show_in_browser(const std::string &path) {
    pid_t child = 0;
    if (spawn({"xdg-open", path}, nullptr, child) != 0) return false;
    std::thread([child] { ::waitpid(child, nullptr, 0); }).detach();
    return true;
}

void handle_signals(void (*stop)(int)) {
    for (const int number : {SIGPIPE, SIGXFSZ}) std::signal(number, SIG_IGN);
    for (const int number : {SIGINT, SIGTERM, SIGHUP})
        if (std::signal(number, stop) == SIG_IGN) std::signal(number, SIG_IGN);
}

} // namespace sparselens::system
