#include "viewing/handed_pictures.h"

#include "base/error.h"
#include "io/exr/exr_flat.h"
#include "io/files/memory_file.h"

#include <fmt/format.h>

#include <algorithm>
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
    const auto file = std::make_shared<const MemoryFile>(
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
