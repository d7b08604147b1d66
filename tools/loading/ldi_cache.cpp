#include "loading/ldi_cache.h"

#include "io/camera/camera_read.h"
#include "chain/channels.h"
#include "loading/notices.h"
#include "loading/recoloured.h"

namespace sparselens {

namespace {

std::vector<std::string> keep_and_tell(Ldi &ldi, const std::string &channels) {
    const std::vector<Channel> before = ldi.channels;
    keep_channels(ldi, channels);
    std::vector<std::string> left_out;
    for (const Channel &channel : before)
        if (find_channel(ldi.channels, channel.name) == npos) left_out.push_back(channel.name);
    return left_out;
}

} // namespace

OpenedLdi &LdiCache::load(const LdiNames &names, const std::string &channels, const OpenOptions &options,
                          const ColourOptions &colour, const ToolContext &tool, const ChooseSamples &choose) {
    const auto &[path, recolor] = names;
    const DepthOptions &depth = options.depth;
    const LensValues &lens = options.lens;
    const Key key(path, channels, depth.meaning, depth.near, depth.far, depth.picture.stereo_view,
                  depth.picture.layer, depth.picture.depth, lens.focal_length_mm, lens.sensor_width_mm,
                  colour.config, colour.input_space, depth.picture.depth_file, recolor,
                  depth.picture.unpremultiplied);
    read_now_ = !last_ || taken_ || key_ != key;
    if (read_now_) {
        last_.reset(); // two at a time may be more than fits
        tool.say("reading " + path);
        OpenedLdi opened = open_ldi(path, options, choose);
        taken_ = opened.reduced();
        say_samples(tool, opened);
        warn_of_invalid_values(tool, path, opened.bad);
        recolor_by(tool, recolor, depth.picture, colour, opened);
        if (recolor.empty()) opened.header = to_linear(tool, colour, path, opened.header, opened.ldi);
        warn_of_flat_picture(tool, opened);
        channels_left_out_ = keep_and_tell(opened.ldi, channels);
        if (auto *packed = std::get_if<PackedRows>(&opened.held)) packed->keep_channels(opened.ldi.channels);
        key_ = key;
        last_ = std::move(opened);
    }
    last_->camera = camera_with_options(lens, read_camera(last_->header));
    return *last_;
}

} // namespace sparselens
