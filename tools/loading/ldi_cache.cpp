#include "loading/ldi_cache.h"

#include "io/camera/camera_read.h"
#include "options/channels.h"

#include <tuple>

namespace sparselens {

namespace {

// All that the samples depend on: depth as ray distance becomes planar by the focal length.
auto key_of(const std::string &path, const std::string &channels, const LensOptions &lens,
            const DepthOptions &depth, const ColourOptions &colour) {
    return std::tuple(path, channels, depth.meaning, depth.channel, depth.far, depth.view,
                      lens.focal_length_mm, lens.sensor_width_mm, colour.config, colour.input_space);
}

std::vector<std::string> keep_and_tell(Ldi &ldi, const std::string &channels) {
    const std::vector<Channel> before = ldi.channels;
    keep_channels(ldi, channels);
    std::vector<std::string> left_out;
    for (const Channel &channel : before)
        if (find_channel(ldi.channels, channel.name) == npos) left_out.push_back(channel.name);
    return left_out;
}

} // namespace

struct LdiCache::Entry {
    decltype(key_of({}, {}, {}, {}, {})) key;
    LoadedLdi loaded;
    std::vector<std::string> channels_left_out;
};

InputLdi LdiCache::load(const std::string &path, const std::string &channels, const LensOptions &lens,
                        const DepthOptions &depth, const ColourOptions &colour, const ToolContext &tool) {
    const auto key = key_of(path, channels, lens, depth, colour);
    const bool read_now = !last_ || last_->key != key;
    if (read_now) {
        last_.reset(); // two at a time may be more than fits
        tool.say("reading " + path);
        auto entry = std::make_shared<Entry>(Entry{key, load_ldi(path, lens, depth), {}});
        say_samples(tool, path, entry->loaded);
        warn_of_invalid_values(tool, path, entry->loaded.bad);
        to_scene_linear(tool, colour, path, entry->loaded.header, entry->loaded.ldi);
        entry->channels_left_out = keep_and_tell(entry->loaded.ldi, channels);
        last_ = std::move(entry);
    }
    const LoadedLdi &loaded = last_->loaded;
    return {path,
            loaded.ldi,
            loaded.header,
            camera_with_options(lens, read_camera(loaded.header)),
            read_now,
            loaded.invisible,
            last_->channels_left_out};
}

} // namespace sparselens
