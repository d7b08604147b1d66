// Input and output of bytes for the EXR readers and writers: whole files, pipes and standard streams.
//
// Output is atomic: it is written to a temporary file beside the target (.NAME.PID-N.partial; a long NAME is cut off),
// which commit() renames. Missing folders are made and symbolic links are followed. A replaced file keeps its mode, and
// must be writable; the umask applies to a new one. Devices, pipes and standard output (`-`) cannot be replaced by
// renaming: their bytes are held in memory and written by commit(). An Error has the reason of the system.
#pragma once

#include <ImfIO.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

// The temporary files of unfinished outputs, so that a process told to stop can remove them. Only SIGKILL or a crash
// leaves one. For its lifetime the file counts as unfinished; at most 64 files are remembered at a time.
class Unfinished {
public:
    explicit Unfinished(std::string path);
    ~Unfinished();
    Unfinished(const Unfinished &) = delete;
    Unfinished &operator=(const Unfinished &) = delete;

    const std::string &path() const { return path_; }

private:
    std::string path_;
    std::size_t slot_;
};

// Unlinks all unfinished files; safe in a signal handler.
void remove_unfinished() noexcept;

class InputStream : public Imf::IStream {
public:
    using Imf::IStream::IStream;
    virtual std::uint64_t bytes() const = 0; // of the whole file
    // Copies `count` bytes from `position` on, or as many as there are, and returns their number. Any number of threads
    // may call it.
    virtual std::uint64_t read_from(std::uint64_t position, char *to, std::uint64_t count) const = 0;
    // A stream of the same bytes for another thread, at their beginning.
    virtual std::unique_ptr<InputStream> another() const = 0;

    // What OpenEXR calls from 3.3 on: it checks a header against the size, and reads without seeking. Earlier versions
    // lack these functions, so they override nothing.
    using Imf::IStream::read;
    virtual std::int64_t size() { return std::int64_t(bytes()); }
    virtual bool isStatelessRead() const { return true; }
    virtual std::int64_t read(void *to, std::uint64_t count, std::uint64_t position) {
        return std::int64_t(read_from(position, static_cast<char *>(to), count));
    }
};

// The expected content of a file. Text of more than 64 MB is refused. A pipe or a device with other content may never
// end, so reading stops at once if it does not begin like an EXR file, or after 64 MB of text.
enum class Content { exr, text, bytes };

// A seekable stream. `-` and files that cannot seek are read into memory completely.
std::unique_ptr<InputStream> open_input(const std::string &path, Content content = Content::exr);

class OutputFile {
public:
    explicit OutputFile(const std::string &path);
    ~OutputFile(); // without commit(), leaves no file behind
    OutputFile(const OutputFile &) = delete;
    OutputFile &operator=(const OutputFile &) = delete;

    Imf::OStream &stream();
    void commit();

    // Whether the bytes go to another process, where compression would only cost time.
    bool to_pipe() const;

private:
    class Buffer;
    std::string path_;                      // as given, for messages
    std::string target_;                    // with links followed; empty if nothing is renamed
    std::unique_ptr<Unfinished> temporary_; // null after commit()
    int descriptor_ = -1;                   // of the temporary file, or of the target itself
    std::unique_ptr<Buffer> buffer_;
};

// Writes all bytes; an Error begins with `path`.
void write_all(const std::string &path, int descriptor, std::string_view bytes);

// The file or folder with this path relative to a folder above the program, or above the library or module that holds
// this code, or else to the installation's prefix; empty if there is none.
std::string find_installed(const std::string &relative);

// Whether `path` stands for standard input or output.
bool is_standard_stream(const std::string &path);

// Whether the file can be read only once: standard input, a pipe or a device.
bool is_read_once(const std::string &path);

// The name of the file in messages.
std::string display_name(const std::string &path);

// Creates the folder and its missing parents. Throws Error, naming it, if that fails.
void make_folder(const std::string &path);

// Throws Error with the file, the action that failed, and the reason that the last system call gave (errno).
[[noreturn]] void fail_of_system(const std::string &path, const std::string &what);

// The error message for a file that is not an EXR file. Judges by its first 8 bytes or more: names the usual picture
// format that the file has, and what to do; otherwise what a photograph may be.
std::string not_exr(std::string_view first_bytes);

} // namespace sparselens
