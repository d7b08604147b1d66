// Input and output of bytes for the EXR readers and writers: whole files, pipes and standard streams.
//
// Output is atomic: it is written to a temporary file beside the target (.NAME.PID-N.partial; a long NAME is cut off),
// which commit() renames. Missing folders are made, symbolic links are followed, and the umask applies. Devices, pipes
// and standard output (`-`) cannot be replaced by renaming: their bytes are held in memory and written by commit().
// Throws Error, naming the file and the reason of the system.
#pragma once

#include "io/files/unfinished.h"

#include <ImfIO.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sparselens {

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

// Whether `path` stands for standard input or output.
bool is_standard_stream(const std::string &path);

// The name of the file in messages.
std::string display_name(const std::string &path);

} // namespace sparselens
