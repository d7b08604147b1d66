#include "io/usd/usd_script.h"

#include "base/error.h"
#include "base/system/system.h"
#include "io/files/text_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace sparselens {

namespace {

std::string last_line(std::string text) {
    while (text.ends_with('\n')) text.pop_back();
    return text.substr(text.find_last_of('\n') + 1);
}

} // namespace

std::string run_usd_script(const std::vector<std::string> &words, const std::string &given,
                           const std::string &file) {
    const char *const named = std::getenv("SPARSELENS_USD_PYTHON");
    const std::string program = named && *named ? named : "python3";
    std::vector<std::string> command{program, "-c", usd_script()};
    command.insert(command.end(), words.begin(), words.end());
    const MemoryFile in(given), out, said;
    const int code = system::run_program(command, {in.path(), out.path(), said.path()});
    if (code < 0)
        throw Error(fmt::format("{}: cannot start {}, which reads and writes USD ({}): name a Python with "
                                "USD's library by SPARSELENS_USD_PYTHON",
                                file, program, std::strerror(errno)));
    if (code == 0) return read_bytes(out.path());
    const std::string why = last_line(read_bytes(said.path()));
    if (why.starts_with(file)) throw Error(why);
    throw Error(fmt::format("{}: {} fails{}{}", file, program, why.empty() ? "" : ": ", why));
}

} // namespace sparselens
