#include "viewing/open_browser.h"

#include "base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <thread>

namespace sparselens {

namespace {

// Says where to go on, and is gone a minute later, or with what cleans the temporary folder.
std::string file_that_leads_to(const std::string &address) {
    std::string path = (std::filesystem::temp_directory_path() / "dof-view-XXXXXX.html").string();
    const int file = ::mkstemps(path.data(), 5); // readable by its owner alone
    const std::string page = fmt::format("<meta http-equiv=\"refresh\" content=\"0;url={}\">\n", address);
    const bool written = file >= 0 && ::write(file, page.data(), page.size()) == ssize_t(page.size());
    if (file >= 0) ::close(file);
    if (!written) throw Error("--open: cannot write " + path);
    return path;
}

} // namespace

void open_browser(const std::string &address) {
    const std::string file = file_that_leads_to(address);
    std::string program = "xdg-open", argument = file;
    char *words[] = {program.data(), argument.data(), nullptr};
    pid_t process = 0;
    if (::posix_spawnp(&process, program.c_str(), nullptr, nullptr, words, environ) != 0) {
        std::filesystem::remove(file);
        throw Error("--open: xdg-open is not there (Debian: xdg-utils); open " + address);
    }
    std::thread([process, file] {
        ::waitpid(process, nullptr, 0);
        std::this_thread::sleep_for(std::chrono::minutes(1));
        std::error_code gone;
        std::filesystem::remove(file, gone);
    }).detach();
}

} // namespace sparselens
