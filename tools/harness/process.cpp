#include "harness/process.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/system/system.h"
#include "base/text.h"
#include "harness/commands/frames.h"
#include "io/files/file_stream.h"
#include "io/files/memory_limit.h"

#include <CLI/CLI.hpp>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <locale>
#include <map>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>

namespace sparselens {

namespace {

int fail(const std::string &prefix, const std::string &text, int code) {
    fmt::print(stderr, "{}{}\n", prefix, one_line(with_options(text)));
    return code;
}

// On a signal to stop: removes half-written files and ends the process by the same signal, as the parent process
// expects.
extern "C" void stop(int number) {
    remove_unfinished();
    std::signal(number, SIG_DFL);
    std::raise(number);
}

// CLI11 2.6 skips thousands separators in numbers, by default a comma: 2,5 would be read as 25.
class NoThousands : public std::numpunct<char> {
    char do_thousands_sep() const override { return '_'; }
};
void take_commas_for_no_digits() {
    [[maybe_unused]] static const std::locale before =
        std::locale::global(std::locale(std::locale(), new NoThousands));
}

// Returns "; did you mean --fstop?", or nothing.
std::string meant_by(const CLI::App &app, const std::string &argument) {
    if (!argument.starts_with('-')) return {};
    std::vector<std::string> names;
    for (const CLI::Option *option : app.get_options())
        for (const std::string &name : option->get_lnames()) names.push_back("--" + name);
    const std::string nearest = nearest_word(argument.substr(0, argument.find('=')), names);
    return nearest.empty() ? nearest : fmt::format("; did you mean {}?", nearest);
}

// Explains the usage error: an argument that was not understood says more than a missing one that follows from it.
std::string explanation(const CLI::App &app, const CLI::ParseError &error) {
    for (const std::string &argument : app.remaining())
        if (argument != "--") return "unknown argument: " + argument + meant_by(app, argument);
    if (dynamic_cast<const CLI::ArgumentMismatch *>(&error))
        for (const CLI::Option *option : app.get_options())
            if (option->get_items_expected_max() == 1 && option->count() > 1)
                return fmt::format("{} is given {} times, with the values {}: give it once",
                                   option->get_name(), option->count(), fmt::join(option->results(), ", "));
    return error.what();
}

// Since 2.4, CLI11 skips a value of the environment that an option's check refuses. Throws an error instead.
void refuse_passed_over(const CLI::App &app) {
    for (const CLI::Option *option : app.get_options()) {
        const std::string &name = option->get_envname();
        const char *value = name.empty() ? nullptr : std::getenv(name.c_str());
        if (value && *value && option->count() == 0)
            throw CLI::ValidationError("$" + name,
                                       fmt::format("'{}' is no value of {}", value, option->get_name()));
    }
}

// Since 2.6, CLI11 checks required options before it calls the options' callbacks; but --device list must print
// and exit first.
void parse_all(CLI::App &app, std::vector<std::string> words) {
    app.allow_windows_style_options(false); // /views/ldi.exr is a file
    try {
        app.parse(std::move(words));
    } catch (const CLI::RequiredError &) {
        for (CLI::Option *option : app.get_options())
            if (option->count() > 0 && !option->get_callback_run()) option->run_callback();
        throw;
    }
    refuse_passed_over(app);
}

} // namespace

void add_process_options(CLI::App &app, ProcessOptions &options) {
    app.set_version_flag("--version", app.get_name() + " (sparselens) " SPARSELENS_VERSION);
    app.add_flag("-v,--verbose", options.verbose, "Print on stderr what the tool found and did");
    app.add_option("--threads", options.threads,
                   "Number of threads; 0: all that the process may use (default: 0)")
        ->type_name("N")
        ->envname("CUE_THREADS")
        ->check(CLI::Range(0, 4096));
    app.add_option("--max-memory", options.max_memory,
                   "Limit of memory, e.g. 4GB, for reading a file (default: 64 MB plus 1100 times its size) "
                   "and for the frames in work (default: a quarter of the machine's)")
        ->type_name("SIZE")
        ->transform(CLI::AsSizeValue(false));
}

namespace {

const std::map<std::string, ProgressFormat> &progress_formats() {
    static const std::map<std::string, ProgressFormat> formats{{"plain", ProgressFormat::plain},
                                                               {"alf", ProgressFormat::alf},
                                                               {"openjd", ProgressFormat::openjd},
                                                               {"none", ProgressFormat::none}};
    return formats;
}

} // namespace

void add_progress_option(CLI::App &app, ProgressFormat &format) {
    app.add_option("--progress", format,
                   "Print progress on stderr. plain: text; alf: for Tractor; openjd: for Open Job "
                   "Description, with status and failures (default: on a terminal after five seconds)")
        ->type_name("plain|alf|openjd|none")
        ->transform(words(progress_formats()))
        ->group("Frames");
}

std::string prefix_of(const std::string &name, const std::vector<std::string> &words) {
    const auto format = progress_formats().find(value_of("--progress", words));
    return error_prefix(format == progress_formats().end() ? ProgressFormat::terminal : format->second, name);
}

// Reports all exceptions, because options also look at files and at what OpenImageIO writes.
std::optional<int> parse_words(CLI::App &app, const std::vector<std::string> &words,
                               const std::string &prefix) {
    take_commas_for_no_digits();
    std::optional<int> answered;
    const int code = exit_code_of(prefix, [&] {
        try {
            parse_all(app, std::vector<std::string>(words.rbegin(), words.rend())); // as CLI11 wants them
        } catch (const CLI::Success &answer) {                                      // --help, --version
            answered = app.exit(answer);
        } catch (const CLI::ParseError &error) {
            answered = fail(prefix, explanation(app, error) + " (see --help)", 2);
        }
    });
    return code == 0 ? answered : code;
}

namespace {

// Keeps freed memory in the process: rows that are read and dropped repeatedly would otherwise return to the system
// each time, which clears their pages again.
void keep_freed_memory() {
#ifdef __GLIBC__
    constexpr int own_pages_from = 4 << 20, kept = 64 << 20; // bytes
    mallopt(M_MMAP_THRESHOLD, own_pages_from);
    mallopt(M_TRIM_THRESHOLD, kept);
#endif
}

} // namespace

std::uint64_t memory_for_frames(const std::optional<std::uint64_t> &max_memory) {
    return max_memory.value_or(memory_of_machine() / 4);
}

namespace {

// How many threads the system lets the process start, `most` at most: containers and farms limit processes, and oneTBB
// ends the process if it cannot start one.
int threads_that_start(int most) {
    std::mutex waiting;
    std::vector<std::thread> started;
    {
        const std::lock_guard until_all_started(waiting);
        try {
            while (int(started.size()) < most)
                started.emplace_back([&waiting] { const std::lock_guard released(waiting); });
        } catch (const std::system_error &) { // no more
        }
    }
    for (std::thread &thread : started) thread.join();
    return int(started.size());
}

} // namespace

void set_up_process(const ProcessOptions &options, const ToolContext &tool) {
    keep_freed_memory();
    const int wanted = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
    // With n threads, oneTBB starts n - 1 and OpenEXR n.
    const int threads = wanted > 1 ? std::max(1, (threads_that_start(2 * wanted - 1) + 1) / 2) : 1;
    // Limits are never destroyed: oneTBB would start threads then, even where the system allows none.
    static auto &limits = *new std::vector<const tbb::global_control *>; // no leak, as it can be reached
    limits.push_back(
        new tbb::global_control(tbb::global_control::max_allowed_parallelism, std::size_t(threads)));
    Imf::setGlobalThreadCount(threads > 1 ? threads : 0);
    set_memory_limit(options.max_memory);
    system::handle_signals(stop);
    tool.say(fmt::format("threads: {}", threads));
}

int exit_code_of(const std::string &prefix, const std::function<void()> &work) {
    try {
        work();
        return 0;
    } catch (const UsageError &error) {
        return fail(prefix, error.what(), 2);
    } catch (const std::bad_alloc &) {
        return fail(prefix, "out of memory", 1);
    } catch (const std::exception &error) {
        return fail(prefix, error.what(), 1);
    }
}

} // namespace sparselens
