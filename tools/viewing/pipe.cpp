#include "viewing/pipe.h"

#include "base/error.h"
#include "base/system/system.h"
#include "harness/progress_lines.h"
#include "io/files/file_stream.h"
#include "viewing/access.h"
#include "viewing/pipe_request.h"
#include "viewing/pipe_service.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace sparselens {

namespace {

using Json = nlohmann::json;

constexpr int pixel_file = 3;

// The two ends of the conversation. Whatever a library reads or prints goes elsewhere from now on: a file may be called
// /dev/stdin.
struct Ends {
    int requests = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, pixel_file + 1);
    int answers = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, pixel_file + 1);

    Ends() {
        const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
        if (requests < 0 || answers < 0 || nothing < 0) fail_of_system("--pipe", "cannot open");
        ::dup2(nothing, STDIN_FILENO);
        ::dup2(STDERR_FILENO, STDOUT_FILENO);
        ::close(nothing);
    }
};

void require_pixel_file() {
    struct stat info {};
    const int flags = ::fcntl(pixel_file, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) != O_RDWR || ::fstat(pixel_file, &info) != 0 ||
        !S_ISREG(info.st_mode))
        throw UsageError(
            "--pipe: descriptor 3 must be a file for reading and writing, where pixels go (3<>FILE)");
}

// Returns false if nobody reads answers any more.
bool say(int file, std::string_view answer) try {
    write_all("--pipe", file, answer);
    return true;
} catch (const Error &) {
    return false;
}

// Reads the pixels that came with a request. Returns less if the file has less.
std::string take_pixels(std::size_t bytes) {
    struct stat info {};
    if (::fstat(pixel_file, &info) != 0) fail_of_system("the file for pixels", "cannot read");
    std::string pixels(std::min(bytes, std::size_t(info.st_size)), '\0');
    pixels.resize(system::read_at(pixel_file, pixels.data(), pixels.size(), 0));
    return pixels;
}

// Makes the file hold these bytes alone.
void put_pixels(std::string_view bytes) {
    if (::ftruncate(pixel_file, 0) != 0) fail_of_system("the file for pixels", "cannot empty");
    for (off_t at = 0; !bytes.empty();) {
        const ssize_t written = ::pwrite(pixel_file, bytes.data(), bytes.size(), at);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) fail_of_system("the file for pixels", "cannot write");
        bytes.remove_prefix(std::size_t(written));
        at += written;
    }
}

// MLT 7.42 sets $OCIO to a configuration that does not exist, whatever the user has set.
void forget_configuration_of_mlt() {
    const char *config = std::getenv("OCIO");
    if (config && std::string_view(config) == "ocio://ocio://default") ::unsetenv("OCIO");
}

// Ends the process if nobody waits for an answer any more, however long a picture still takes.
class Watch {
public:
    explicit Watch(int answers)
        : thread_([this, answers, parent = ::getppid()] { watch(answers, parent); }) {}
    ~Watch() {
        ended_ = true;
        thread_.join();
    }
    Watch(const Watch &) = delete;
    Watch &operator=(const Watch &) = delete;

private:
    void watch(int answers, pid_t parent) const {
        constexpr int between = 200; // ms
        while (!ended_) {
            pollfd file{answers, 0, 0};
            const int found = ::poll(&file, 1, between);
            if (found > 0 && (file.revents & (POLLERR | POLLHUP)) != 0) std::_Exit(0);
            if (::getppid() != parent) std::_Exit(0);
            if (found > 0) std::this_thread::sleep_for(std::chrono::milliseconds(between));
        }
    }

    std::atomic<bool> ended_ = false;
    std::thread thread_;
};

// Takes lines out of what is read. A line that is too long is dropped, and taken as too long once.
class Lines {
public:
    explicit Lines(int file) : file_(file) {}

    // The next line, without its end; empty at the end of the file. Throws UsageError for a line that is too long.
    std::optional<std::string> next() {
        for (;;) {
            if (const std::size_t end = received_.find('\n'); end != std::string::npos) {
                std::string line = received_.substr(0, end);
                received_.erase(0, end + 1);
                if (!std::exchange(too_long_, false) && line.size() <= longest_request) return line;
                throw UsageError(fmt::format("the request: it is longer than {} bytes", longest_request));
            }
            if (received_.size() > longest_request) {
                too_long_ = true;
                received_.clear();
            }
            if (!receive()) return {};
        }
    }

private:
    bool receive() {
        char bytes[4096];
        ssize_t count = 0;
        do count = ::read(file_, bytes, sizeof bytes);
        while (count < 0 && errno == EINTR);
        if (count > 0) received_.append(bytes, std::size_t(count));
        return count > 0;
    }

    int file_;
    std::string received_;
    bool too_long_ = false;
};

std::string answer_line(int status, std::size_t bytes, const std::string &text) {
    return fmt::format("{} {} {}\n", status, bytes, one_line(text));
}

std::string answer_to(PipeService &service, const std::string &line) {
    PipeRequest request = parse_pipe_request(line);
    if (request.handed) service.take(request, take_pixels(request.handed->bytes()));
    PipeService::Answer answer = service.answer(request);
    put_pixels(answer.pixels);
    return answer_line(200, answer.pixels.size(),
                       answer.said.dump(-1, ' ', false, Json::error_handler_t::replace));
}

// The answer to the next line; empty at the end.
std::optional<std::string> next_answer(PipeService &service, Lines &lines) {
    try {
        const std::optional<std::string> line = lines.next();
        if (!line) return {};
        return answer_to(service, *line);
    } catch (const std::exception &) {
        const Refusal refusal = refusal_of_exception();
        return answer_line(refusal.status, 0,
                           InMemoryPictures::in_words(refusal.why)); // text from a file may not be UTF-8
    }
}

} // namespace

void answer_pipe(const ToolContext &tool) {
    require_pixel_file();
    forget_configuration_of_mlt();
    const Ends ends;
    const Watch watch(ends.answers);
    PipeService service(tool);
    Lines lines(ends.requests);
    const Json greeting{{"sparselens", SPARSELENS_VERSION}, {"pipe", pipe_version}};
    std::optional<std::string> answer = answer_line(200, 0, greeting.dump());
    for (; answer && say(ends.answers, *answer); answer = next_answer(service, lines)) {
    }
}

} // namespace sparselens
