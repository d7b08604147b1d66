#include "base/error.h"
#include "io/files/file_stream.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>

namespace sparselens {

namespace {

class MemoryInput : public InputStream {
public:
    MemoryInput(const std::string &name, std::shared_ptr<const std::vector<char>> bytes)
        : InputStream(name.c_str()), bytes_(std::move(bytes)) {}

    using InputStream::read;
    bool read(char c[], int n) override {
        if (n < 0 || std::uint64_t(n) > bytes_->size() - position_)
            throw Error(std::string(fileName()) + ": the file is truncated");
        std::memcpy(c, bytes_->data() + position_, std::size_t(n));
        position_ += std::uint64_t(n);
        return position_ < bytes_->size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override {
        if (position > bytes_->size()) throw Error(std::string(fileName()) + ": the file is truncated");
        position_ = position;
    }
    std::uint64_t bytes() const override { return bytes_->size(); }
    std::uint64_t read_from(std::uint64_t position, char *to, std::uint64_t count) const override {
        const std::uint64_t there = std::min(count, bytes_->size() - std::min(position, bytes()));
        std::copy_n(bytes_->begin() + std::ptrdiff_t(std::min(position, bytes())), there, to);
        return there;
    }
    std::unique_ptr<InputStream> another() const override {
        return std::make_unique<MemoryInput>(fileName(), bytes_);
    }

private:
    std::shared_ptr<const std::vector<char>> bytes_;
    std::uint64_t position_ = 0;
};

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() { ::close(number_); }
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;
    int number() const { return number_; }

private:
    int number_;
};

// Reads bytes of a file from `position` on. Returns their number: fewer than `most` at the end, or if it cannot be
// read.
std::size_t read_at(int descriptor, char *to, std::size_t most, std::uint64_t position) {
    std::size_t got = 0;
    while (got < most) {
        const ssize_t more = ::pread(descriptor, to + got, most - got, off_t(position + got));
        if (more < 0 && errno == EINTR) continue;
        if (more <= 0) break;
        got += std::size_t(more);
    }
    return got;
}

// Reads small pieces, such as those of headers, through a buffer.
class FileInput : public InputStream {
public:
    FileInput(const std::string &name, std::shared_ptr<const Descriptor> file, std::uint64_t size)
        : InputStream(name.c_str()), file_(std::move(file)), size_(size) {}

    using InputStream::read;
    bool read(char c[], int n) override {
        if (n < 0 || position_ > most_bytes - std::uint64_t(n)) fail_as_truncated();
        const auto wanted = std::size_t(n);
        if (position_ < start_ || position_ + wanted > start_ + buffer_.size()) {
            if (wanted >= buffered) return read_direct(c, wanted);
            start_ = position_;
            buffer_.resize(buffered);
            buffer_.resize(read_at(file_->number(), buffer_.data(), buffered, start_));
            if (wanted > buffer_.size()) fail_as_truncated();
        }
        std::memcpy(c, buffer_.data() + (position_ - start_), wanted);
        position_ += wanted;
        return true;
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }
    std::uint64_t bytes() const override { return size_; }
    std::uint64_t read_from(std::uint64_t position, char *to, std::uint64_t count) const override {
        if (position > most_bytes || count > most_bytes - position) fail_as_truncated();
        return read_at(file_->number(), to, count, position);
    }
    std::unique_ptr<InputStream> another() const override {
        return std::make_unique<FileInput>(fileName(), file_, size_);
    }

private:
    static constexpr std::size_t buffered = 4096;
    static constexpr std::uint64_t most_bytes = std::numeric_limits<off_t>::max();

    [[noreturn]] void fail_as_truncated() const {
        throw Error(std::string(fileName()) + ": the file is truncated");
    }
    bool read_direct(char *c, std::size_t wanted) {
        if (read_at(file_->number(), c, wanted, position_) != wanted) fail_as_truncated();
        position_ += wanted;
        return true;
    }

    std::shared_ptr<const Descriptor> file_;
    std::uint64_t size_, position_ = 0;
    std::uint64_t start_ = 0; // file position of the buffer's first byte
    std::vector<char> buffer_;
};

constexpr char exr_magic[] = {0x76, 0x2f, 0x31, 0x01};

constexpr std::size_t most_text = std::size_t(64) << 20;

void check_size(const std::string &path, std::uint64_t bytes, Content content) {
    if (content == Content::text && bytes > most_text)
        throw Error(display_name(path) + ": has more than 64 MB of text, which is not what is read here");
}

void check_stream(const std::string &path, const std::vector<char> &bytes, std::size_t used,
                  Content content) {
    check_size(path, used, content);
    if (content == Content::exr && used >= sizeof exr_magic &&
        std::memcmp(bytes.data(), exr_magic, sizeof exr_magic) != 0)
        throw Error(display_name(path) + ": " + not_exr({bytes.data(), used}));
}

std::vector<char> read_whole(const std::string &path, int descriptor, Content content) {
    std::vector<char> bytes;
    std::size_t used = 0;
    for (;;) {
        if (used == bytes.size()) bytes.resize(std::max<std::size_t>(1 << 20, 2 * used));
        const ssize_t got = ::read(descriptor, bytes.data() + used, bytes.size() - used);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail_of_system(path, "cannot read");
        if (got == 0) break;
        used += std::size_t(got);
        check_stream(path, bytes, used, content);
    }
    bytes.resize(used);
    return bytes;
}

using namespace std::string_view_literals;

struct Format {
    std::string_view begins, name;
};
constexpr std::array<Format, 8> formats{{{"\x89PNG"sv, "a PNG"},
                                         {"\xff\xd8\xff"sv, "a JPEG"},
                                         {"II*\0"sv, "a TIFF"},
                                         {"MM\0*"sv, "a TIFF"},
                                         {"SDPX"sv, "a DPX"},
                                         {"XPDS"sv, "a DPX"},
                                         {"#?RADIANCE"sv, "a Radiance"},
                                         {"#?RGBE"sv, "a Radiance"}}};

} // namespace

std::unique_ptr<InputStream> open_input(const std::string &path, Content content) {
    const auto in_memory = [&](int descriptor) {
        return std::make_unique<MemoryInput>(display_name(path), std::make_shared<const std::vector<char>>(
                                                                     read_whole(path, descriptor, content)));
    };
    if (path == "-") return in_memory(STDIN_FILENO);
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) fail_of_system(path, "cannot open");
    const auto file = std::make_shared<const Descriptor>(descriptor);
    struct stat info {};
    if (::fstat(descriptor, &info) == 0 && S_ISDIR(info.st_mode))
        throw Error(path + ": is a folder, not a file");
    if (S_ISREG(info.st_mode)) {
        check_size(path, std::uint64_t(info.st_size), content);
        return std::make_unique<FileInput>(path, file, std::uint64_t(info.st_size));
    }
    return in_memory(descriptor);
}

std::string not_exr(std::string_view first_bytes) {
    for (const Format &format : formats)
        if (first_bytes.starts_with(format.begins))
            return fmt::format(
                "is {} picture, and EXR is needed: render to EXR, with depth, or convert what needs "
                "no depth (oiiotool IN -o OUT.exr)",
                format.name);
    return "not an EXR file";
}

} // namespace sparselens
