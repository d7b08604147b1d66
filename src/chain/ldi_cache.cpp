#include "chain/ldi_cache.h"

#include "chain/channels.h"
#include "chain/file_notices.h"
#include "chain/flat_light.h"
#include "deep/checks/view_warnings.h"
#include "deep/front_samples.h"
#include "io/camera/camera_read.h"

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

// Checks flat pictures only, because deep pictures are made by programs that write them correctly.
void check_flat_picture(const Tell &tell, const OpenedLdi &in) {
    if (in.deep) return;
    tell_warnings(tell, picture_warnings(front_view(in.ldi, in.name),
                                         {in.depth, in.depth_filtered, in.camera, in.unpremultiplied}));
}

} // namespace

// An LDI whose samples were used up does not even have empty pixels.
bool LdiCache::holds(const Key &key) const {
    return last_ && key_ == key && !last_->reduced() && !last_->ldi.begin.empty();
}

OpenedLdi &LdiCache::load(const LdiRequest &request, const Tell &tell, const ChooseSamples &choose) {
    const auto &[path, recolor, channels, lens, depth, colour] = request;
    const Key key(path, channels, depth.meaning, depth.near, depth.far, depth.picture.stereo_view,
                  depth.picture.layer, depth.picture.depth, lens.focal_length_mm, lens.sensor_width_mm,
                  colour.config, colour.input_space, depth.picture.depth_file, recolor,
                  depth.picture.unpremultiplied);
    read_now_ = !holds(key);
    if (read_now_) {
        last_.reset(); // because two at a time may not fit in memory
        tell({NoticeKind::reading, path});
        OpenedLdi opened = open_ldi(path, {lens, depth}, choose);
        tell_samples(tell, opened);
        recolor_by(recolor, depth.picture, colour, opened, tell);
        if (recolor.empty()) opened.header = to_linear(tell, colour, path, opened.header, opened.ldi);
        check_flat_picture(tell, opened);
        channels_left_out_ = keep_and_tell(opened.ldi, channels);
        if (auto *packed = std::get_if<PackedRows>(&opened.held)) packed->keep_channels(opened.ldi.channels);
        key_ = key;
        last_ = std::move(opened);
    }
    last_->camera = read_camera(last_->header);
    return *last_;
}

} // namespace sparselens
