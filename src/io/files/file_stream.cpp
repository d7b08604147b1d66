#include "io/files/file_stream.h"

#include "base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

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
        if (const char *name = path) ::unlink(name);
}

namespace {

void write_all(const std::string &path, int descriptor, const char *data, std::size_t size) {
    while (size > 0) {
        const ssize_t put = ::write(descriptor, data, size);
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) fail_of_system(path, "cannot write");
        data += put;
        size -= std::size_t(put);
    }
}

bool is_regular_or_new(const std::string &path) {
    struct stat info {};
    return ::stat(path.c_str(), &info) != 0 || S_ISREG(info.st_mode);
}

// The file to which a path leads, even if the last link points at a file that does not exist yet.
std::filesystem::path follow_links(const std::string &path) {
    std::filesystem::path target = path;
    for (int depth = 0; std::filesystem::is_symlink(target); ++depth) {
        if (depth == 40) { // the kernel's limit
            errno = ELOOP;
            fail_of_system(path, "cannot write");
        }
        const std::filesystem::path next = std::filesystem::read_symlink(target);
        target = next.is_absolute() ? next : target.parent_path() / next;
    }
    return target;
}

} // namespace

bool is_standard_stream(const std::string &path) { return path == "-"; }

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
            if (::lseek(descriptor_, off_t(position), SEEK_SET) < 0)
                fail_of_system(fileName(), "cannot seek");
            start_ = position;
        } else {
            position_ = std::size_t(position);
        }
    }
    void flush() {
        write_all(fileName(), descriptor_, bytes_.data(), bytes_.size());
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
        descriptor_ = ::dup(STDOUT_FILENO);
    } else if (!is_regular_or_new(path)) {
        descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
        const std::filesystem::path target = follow_links(path);
        target_ = target.string();
        if (target.has_parent_path()) make_folder(target.parent_path().string());
        constexpr std::size_t longest = 200; // file systems take 255, the rest of the name included
        const std::string name = target.filename().string().substr(0, longest);
        for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
            const std::string unique = fmt::format(".{}.{}-{}.partial", name, ::getpid(), attempt);
            temporary_ = std::make_unique<Unfinished>((target.parent_path() / unique).string());
            descriptor_ = ::open(temporary_->path().c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (descriptor_ < 0 && errno != EEXIST) break;
        }
    }
    if (descriptor_ < 0) {
        temporary_.reset();
        fail_of_system(path, "cannot write");
    }
    buffer_ = std::make_unique<Buffer>(display_name(path), descriptor_, !target_.empty());
}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (temporary_) ::unlink(temporary_->path().c_str());
}

Imf::OStream &OutputFile::stream() { return *buffer_; }

bool OutputFile::to_pipe() const {
    struct stat info {};
    return ::fstat(descriptor_, &info) == 0 && (S_ISFIFO(info.st_mode) || S_ISSOCK(info.st_mode));
}

void OutputFile::commit() {
    buffer_->flush();
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0) fail_of_system(path_, "cannot write");
    if (target_.empty()) return;
    if (::rename(temporary_->path().c_str(), target_.c_str()) != 0)
        fail_of_system(path_, "cannot rename the finished file");
    temporary_.reset();
}

void make_folder(const std::string &path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) throw Error(path + ": cannot create the folder: " + error.message());
}

} // namespace sparselens
