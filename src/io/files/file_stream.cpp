#include "io/files/file_stream.h"

#include "base/error.h"
#include "base/system/system.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>

namespace sparselens {

namespace {

std::array<std::atomic<const char *>, 64> paths{};
static_assert(std::atomic<const char *>::is_always_lock_free, "a signal handler cannot wait for locks");

} // namespace

Unfinished::Unfinished(std::string path) : path_(std::move(path)), slot_(0) {
    for (; slot_ < paths.size(); ++slot_) {
        const char *none = nullptr;
        if (paths[slot_].compare_exchange_strong(none, path_.c_str())) return;
    }
}

Unfinished::~Unfinished() {
    if (slot_ < paths.size()) paths[slot_] = nullptr;
}

void remove_unfinished() noexcept {
    for (const auto &path : paths)
        if (const char *name = path) std::remove(name);
}

namespace {

namespace fs = std::filesystem;

// The mode of a file that a new one replaces; nothing if there is none. Throws Error if it is read-only: renaming would
// replace it all the same.
std::optional<fs::perms> mode_to_keep(const std::string &target) {
    std::error_code unknown;
    const fs::file_status status = fs::status(target, unknown);
    if (!fs::exists(status)) return {};
    if (!system::may_write(target)) fail_of_system(target, "cannot replace");
    return status.permissions();
}

bool is_regular_or_new(const std::string &path) {
    std::error_code unknown;
    const fs::file_status status = fs::status(path, unknown);
    return !fs::exists(status) || fs::is_regular_file(status);
}

// The file to which a path leads, even if the last link points at a file that does not exist yet.
fs::path follow_links(const std::string &path) {
    fs::path target = path;
    for (int depth = 0; fs::is_symlink(target); ++depth) {
        if (depth == 40) { // the kernel's limit
            errno = ELOOP;
            fail_of_system(path, "cannot write");
        }
        const fs::path next = fs::read_symlink(target);
        target = next.is_absolute() ? next : target.parent_path() / next;
    }
    return target;
}

} // namespace

void write_all(const std::string &path, int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const std::ptrdiff_t put = system::write(descriptor, bytes.data(), bytes.size());
        if (put <= 0) fail_of_system(path, "cannot write");
        bytes.remove_prefix(std::size_t(put));
    }
}

std::string find_installed(const std::string &relative) {
    std::error_code unknown;
    for (const fs::path of : system::own_files())
        for (fs::path folder = of.parent_path(); folder != folder.parent_path();
             folder = folder.parent_path())
            if (fs::exists(folder / relative, unknown)) return (folder / relative).string();
    const fs::path installed = fs::path(SPARSELENS_PREFIX) / relative;
    return fs::exists(installed, unknown) ? installed.string() : "";
}

bool is_standard_stream(const std::string &path) { return path == "-"; }

bool is_read_once(const std::string &path) { return path == "-" || !is_regular_or_new(path); }

std::string display_name(const std::string &path) { return path == "-" ? "standard stream" : path; }

void fail_of_system(const std::string &path, const std::string &what) {
    throw Error(display_name(path) + ": " + what + ": " + std::strerror(errno));
}

// Collects bytes. If there is a temporary file, it writes them to it in large pieces.
class OutputFile::Buffer : public Imf::OStream {
public:
    Buffer(const std::string &path, int descriptor, bool to_file)
        : Imf::OStream(path.c_str()), descriptor_(descriptor), to_file_(to_file) {}

    void write(const char c[], int n) override {
        const std::size_t end = position_ + std::size_t(n);
        if (end > bytes_.size()) bytes_.resize(end);
        std::memcpy(bytes_.data() + position_, c, std::size_t(n));
        position_ = end;
        if (to_file_ && bytes_.size() >= piece) flush();
    }
    std::uint64_t tellp() override { return start_ + position_; }
    void seekp(std::uint64_t position) override {
        if (to_file_) {
            flush();
            if (!system::seek(descriptor_, position)) fail_of_system(fileName(), "cannot seek");
            start_ = position;
        } else {
            position_ = std::size_t(position);
        }
    }
    void flush() {
        write_all(fileName(), descriptor_, {bytes_.data(), bytes_.size()});
        start_ += bytes_.size();
        position_ = 0;
        bytes_.clear();
    }

private:
    static constexpr std::size_t piece = std::size_t(1) << 20;
    int descriptor_;
    bool to_file_;
    std::uint64_t start_ = 0;  // file position of bytes_[0]
    std::size_t position_ = 0; // in bytes_
    std::vector<char> bytes_;
};

OutputFile::OutputFile(const std::string &path) : path_(path) {
    if (path == "-") {
        descriptor_ = system::duplicate(system::standard_output);
    } else if (!is_regular_or_new(path)) {
        descriptor_ = system::open(path, system::Open::write);
    } else {
        const fs::path target = follow_links(path);
        target_ = target.string();
        if (target.has_parent_path()) make_folder(target.parent_path().string());
        const std::optional<fs::perms> mode = mode_to_keep(target_);
        constexpr std::size_t longest = 200; // file systems take 255, the rest of the name included
        const std::string name = target.filename().string().substr(0, longest);
        for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
            const std::string unique = fmt::format(".{}.{}-{}.partial", name, system::process_id(), attempt);
            temporary_ = std::make_unique<Unfinished>((target.parent_path() / unique).string());
            descriptor_ = system::open(temporary_->path(), system::Open::create);
            if (descriptor_ < 0 && errno != EEXIST) break;
        }
        std::error_code none; // as far as the file system has modes
        if (mode && descriptor_ >= 0) fs::permissions(temporary_->path(), *mode, none);
    }
    if (descriptor_ < 0) {
        temporary_.reset();
        fail_of_system(path, "cannot write");
    }
    buffer_ = std::make_unique<Buffer>(display_name(path), descriptor_, !target_.empty());
}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) system::close(descriptor_);
    if (temporary_) std::remove(temporary_->path().c_str());
}

Imf::OStream &OutputFile::stream() { return *buffer_; }

bool OutputFile::to_pipe() const { return system::is_pipe(descriptor_); }

void OutputFile::commit() {
    buffer_->flush();
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (!system::close(descriptor)) fail_of_system(path_, "cannot write");
    if (target_.empty()) return;
    std::error_code error;
    fs::rename(temporary_->path(), target_, error);
    if (error) throw Error(display_name(path_) + ": cannot rename the finished file: " + error.message());
    temporary_.reset();
}

void make_folder(const std::string &path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw Error(path + ": cannot create the folder: " + error.message());
}

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

struct Descriptor {
    explicit Descriptor(int opened) : number(opened) {}
    ~Descriptor() { system::close(number); }
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;
    const int number;
};

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
            buffer_.resize(system::read_at(file_->number, buffer_.data(), buffered, start_));
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
        return system::read_at(file_->number, to, count, position);
    }
    std::unique_ptr<InputStream> another() const override {
        return std::make_unique<FileInput>(fileName(), file_, size_);
    }

private:
    static constexpr std::size_t buffered = 4096;
    static constexpr std::uint64_t most_bytes = std::numeric_limits<std::int64_t>::max();

    [[noreturn]] void fail_as_truncated() const {
        throw Error(std::string(fileName()) + ": the file is truncated");
    }
    bool read_direct(char *c, std::size_t wanted) {
        if (system::read_at(file_->number, c, wanted, position_) != wanted) fail_as_truncated();
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
        throw Error(display_name(path) +
                    ": has more than 64 MB of text: it is not the file that is needed here");
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
        const std::ptrdiff_t got = system::read(descriptor, bytes.data() + used, bytes.size() - used);
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

// Whether a name is a pattern that a shell would have replaced.
bool is_for_the_shell(const std::string &path) {
    return path.starts_with('~') || path.find_first_of("{*?") != std::string::npos;
}

} // namespace

std::unique_ptr<InputStream> open_input(const std::string &path, Content content) {
    const auto in_memory = [&](int descriptor) {
        return std::make_unique<MemoryInput>(display_name(path), std::make_shared<const std::vector<char>>(
                                                                     read_whole(path, descriptor, content)));
    };
    if (path == "-") return in_memory(system::standard_input);
    std::error_code unknown;
    if (fs::is_directory(path, unknown)) throw Error(path + ": is a folder, not a file");
    const int descriptor = system::open(path, system::Open::read);
    if (descriptor < 0 && errno == ENOENT && is_for_the_shell(path))
        throw Error(path +
                    ": there is no such file: the shell replaces {0..3}, *, ? and ~ only outside of quotes");
    if (descriptor < 0) fail_of_system(path, "cannot open");
    const auto file = std::make_shared<const Descriptor>(descriptor);
    if (const auto size = system::size_of(descriptor)) {
        check_size(path, *size, content);
        return std::make_unique<FileInput>(path, file, *size);
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
    if (first_bytes.starts_with("\x93NUMPY")) return "is a NumPy array: save it as a 16-bit PNG, white near";
    return "not an EXR file; a photograph or its depth may be a PNG, JPEG or TIFF (oiiotool IN -o OUT.png)";
}

} // namespace sparselens
