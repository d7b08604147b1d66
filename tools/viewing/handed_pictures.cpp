#include "viewing/handed_pictures.h"

#include "base/error.h"
#include "io/exr/exr_flat.h"
#include "io/files/system_error.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <regex>
#include <string_view>
#include <utility>

namespace sparselens {

namespace {

constexpr std::size_t most_kept = 4; // programs ask for parts of a few pictures by turns
constexpr const char *name = "the picture that was handed over";

Image image_of(const HandedLayout &layout, const std::string &pixels) {
    std::vector<Channel> channels;
    for (const std::string &channel : layout.channels) channels.push_back({channel, PixelType::float32});
    Image image(layout.windows, std::move(channels));
    const std::size_t count = layout.channels.size();
    for (std::size_t k = 0; k < count; ++k) {
        const std::span<float> plane = image.plane(k);
        for (std::size_t i = 0; i < plane.size(); ++i)
            std::memcpy(&plane[i], pixels.data() + (i * count + k) * sizeof(float), sizeof(float));
    }
    return image;
}

} // namespace

// A file in memory. It is gone with the object.
class HandedPictures::File {
public:
    explicit File(std::string_view bytes) : file_(::memfd_create("sparselens-handed", MFD_CLOEXEC)) {
        while (file_ >= 0 && !bytes.empty()) {
            const ssize_t written = ::write(file_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) break;
            bytes.remove_prefix(std::size_t(written));
        }
        if (file_ >= 0 && bytes.empty()) return;
        if (file_ >= 0) ::close(file_);
        fail_of_system(name, "cannot keep");
    }
    ~File() { ::close(file_); }
    File(const File &) = delete;
    File &operator=(const File &) = delete;

    std::string path() const { return fmt::format("/proc/self/fd/{}", file_); }

private:
    int file_;
};

std::string HandedPictures::path_of(const HandedLayout &layout, std::string pixels) {
    if (pixels.size() != layout.bytes())
        throw UsageError(fmt::format("the request: {} has {} bytes of pixels instead of {}", name,
                                     pixels.size(), layout.bytes()));
    const auto found = std::ranges::find_if(
        kept_, [&](const Kept &kept) { return kept.layout == layout && kept.pixels == pixels; });
    if (found != kept_.end()) {
        kept_.splice(kept_.begin(), kept_, found);
        return kept_.front().file->path();
    }
    const Imf::Header no_metadata;
    const auto file = std::make_shared<const File>(
        flat_exr(name, image_of(layout, pixels), no_metadata, Imf::NO_COMPRESSION));
    if (kept_.size() >= most_kept) kept_.pop_back();
    kept_.push_front({layout, std::move(pixels), file});
    return file->path();
}

std::string HandedPictures::in_words(std::string message) {
    static const std::regex path("/proc/self/fd/[0-9]+");
    return std::regex_replace(message, path, name);
}

} // namespace sparselens
