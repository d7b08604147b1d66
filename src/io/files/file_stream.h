// Bytes in and out for the EXR readers and writers: whole files, pipes, standard streams.
//
// An output appears whole or not at all: it is written to a temporary file beside the target
// (.NAME.PID-N.partial, a long NAME cut) and renamed by commit(); symbolic links are followed, the umask is
// kept. Devices, pipes and standard output (`-`) cannot be renamed over: their bytes are held in memory and
// written by commit().
// Errors (Error) name the file and the system's reason.
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
    virtual std::uint64_t size() const = 0; // bytes
};

// A seekable stream; `-` and whatever cannot seek is read whole into memory.
std::unique_ptr<InputStream> open_input(const std::string &path);

class OutputFile {
public:
    explicit OutputFile(const std::string &path);
    ~OutputFile(); // without commit: nothing is left behind
    OutputFile(const OutputFile &) = delete;
    OutputFile &operator=(const OutputFile &) = delete;

    Imf::OStream &stream();
    void commit();

    // Whether the bytes go to another process: compressing them would only cost both time.
    bool to_pipe() const;

private:
    class Buffer;
    std::string path_;                      // as given, for messages
    std::string target_;                    // links followed; empty: not renamed, written through
    std::unique_ptr<Unfinished> temporary_; // none once committed
    int descriptor_ = -1;                   // of the temporary, or of what is written through
    std::unique_ptr<Buffer> buffer_;
};

// How the file is called in messages.
std::string display_name(const std::string &path);

} // namespace sparselens
