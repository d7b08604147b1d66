// Calls of the operating system, which differ from one to the next: posix.cpp has them for Linux, windows.cpp for Windows.
// Names are UTF-8, and files are binary. A function that fails returns -1, false or nothing, and errno has the reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sparselens::system {

#ifdef _WIN32
inline constexpr const char *separators = "/\\"; // of folders in a path
#else
inline constexpr const char *separators = "/";
#endif

inline constexpr int standard_input = 0, standard_output = 1, standard_error = 2;

// A file by its number; a child process does not have it. `create` makes a new file to read and write, which only its
// owner may use if it is `secret`.
enum class Open { read, write, append, create, secret };
int open(const std::string &path, Open how);
int duplicate(int file);
bool close(int file);
bool resize(int file, std::uint64_t bytes);
bool seek(int file, std::uint64_t position);

// These read and write at the file's position, and return the number of bytes; 0 at the end of the file. read_at() reads
// from another position on, and returns fewer bytes than `most` at the end, or if they cannot be read.
std::ptrdiff_t read(int file, char *to, std::size_t most);
std::ptrdiff_t write(int file, const char *from, std::size_t count);
std::size_t read_at(int file, char *to, std::size_t most, std::uint64_t position);

std::optional<std::uint64_t> size_of(int file); // nothing for a pipe or a device
bool is_pipe(int file);                         // whether another process has the other end
bool is_terminal(int file);

// A file for code that opens files by name; it is removed with this object. In Linux it is in no folder, so no other user
// can open it, put a link in its place, or find it after a crash.
class UnnamedFile {
public:
    UnnamedFile();
    ~UnnamedFile();
    UnnamedFile(const UnnamedFile &) = delete;
    UnnamedFile &operator=(const UnnamedFile &) = delete;

    int number() const { return number_; }            // -1 if the system provides none
    const std::string &path() const { return path_; } // opens it, in this process only

private:
    int number_ = -1;
    std::string path_;
};

bool may_write(const std::string &path); // to a file that exists

// All names of one file have the same identity; a folder or a device has none. The state is another text after the file
// was written again or replaced. stamp_of() returns nothing if there is no file.
struct FileStamp {
    std::string identity, state;
};
std::optional<FileStamp> stamp_of(const std::string &path);

// The program, and the library or module that holds this code.
std::vector<std::string> own_files();
int process_id();
std::uint64_t physical_memory(); // bytes

// Loads a library, which stays loaded, and finds a function of it. Both return null if there is none; loading_error()
// says why.
void *load_library(const std::string &path);
void *function_of(void *library, const char *name);
std::string loading_error();

// Runs a program, found by PATH, with these files as its standard streams. Returns its exit code, or another number than
// 0 if a signal ended it; -1 if it cannot be started.
int run_program(const std::vector<std::string> &words, const std::vector<std::string> &streams);

// Shows the file in a browser, without waiting for it; false if there is none.
bool show_in_browser(const std::string &path);

// Calls `stop` with a signal that asks the process to end, unless it is ignored as under nohup. A closed pipe and a file
// that grows too large are errors to report, not a silent end.
void handle_signals(void (*stop)(int));

} // namespace sparselens::system
