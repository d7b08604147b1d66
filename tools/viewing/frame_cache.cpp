#include "viewing/frame_cache.h"

#include "base/error.h"
#include "deep/flatten.h"

#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <set>
#include <utility>

namespace sparselens {

FrameCache::FrameCache(const std::vector<std::string> &paths, std::uint64_t most_bytes, Read read)
    : most_bytes_(most_bytes), read_(std::move(read)) {
    std::set<std::string> seen;
    for (const std::string &path : paths)
        if (seen.insert(path).second) paths_.push_back(path);
    bad_.resize(paths_.size());
    if (paths_.size() > 1) reader_ = std::thread([this] { read_ahead(); });
}

FrameCache::~FrameCache() {
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
        changed_.notify_all();
    }
    if (reader_.joinable()) reader_.join();
}

std::size_t FrameCache::number_of(const std::string &path) const {
    return std::size_t(std::ranges::find(paths_, path) - paths_.begin());
}

// The number of steps from the last requested frame, in the direction of the requests, wrapping at the end.
std::size_t FrameCache::ahead(std::size_t number) const {
    const std::size_t count = paths_.size();
    return (forwards_ ? number + count - last_asked_ : last_asked_ + count - number) % count;
}

FrameCache::Held FrameCache::at(const std::string &path) {
    const std::size_t number = number_of(path);
    std::unique_lock lock(mutex_);
    if (number != last_asked_) {
        forwards_ = true;
        forwards_ = ahead(number) <= paths_.size() / 2; // the shorter way
        last_asked_ = number;
        changed_.notify_all();
    }
    changed_.wait(lock, [&] { return held_.contains(number) || !reading_; });
    const auto found = held_.find(number);
    return found != held_.end() ? found->second : read(lock, number);
}

std::size_t FrameCache::held() const {
    const std::lock_guard lock(mutex_);
    return held_.size();
}

bool FrameCache::holds(const std::string &path) const {
    const std::lock_guard lock(mutex_);
    return held_.contains(number_of(path));
}

// Frees the farthest frames until `bytes` more fit, but never the last requested one.
void FrameCache::make_room(std::uint64_t bytes) {
    while (held_bytes_ + bytes > most_bytes_) {
        const auto farthest =
            std::ranges::max_element(held_, {}, [this](const auto &frame) { return ahead(frame.first); });
        if (farthest == held_.end() || farthest->first == last_asked_) return;
        held_bytes_ -= farthest->second->packed.bytes();
        held_.erase(farthest);
    }
}

// Reads a frame; no other thread reads meanwhile.
FrameCache::Held FrameCache::read(std::unique_lock<std::mutex> &lock, std::size_t number) {
    reading_ = true;
    make_room(largest_);
    lock.unlock();
    Held frame;
    std::exception_ptr failure;
    try {
        frame = std::make_shared<const LoadedFrame>(read_(paths_.at(number)));
    } catch (...) {
        failure = std::current_exception();
    }
    lock.lock();
    reading_ = false;
    changed_.notify_all();
    if (failure) std::rethrow_exception(failure);
    bad_[number] = false;
    held_[number] = frame;
    held_bytes_ += frame->packed.bytes();
    largest_ = std::max(largest_, frame->packed.bytes());
    make_room(0);
    return frame;
}

// The nearest frame that is not held, if it fits beside the nearer ones.
std::optional<std::size_t> FrameCache::next_ahead() const {
    std::uint64_t nearer = 0;
    for (std::size_t step = 0; step < paths_.size(); ++step) {
        const std::size_t count = paths_.size(),
                          number = (forwards_ ? last_asked_ + step : last_asked_ + count - step) % count;
        const auto found = held_.find(number);
        if (found != held_.end())
            nearer += found->second->packed.bytes();
        else if (step == 0)
            return {}; // at() reads it
        else if (!bad_[number])
            return nearer + largest_ <= most_bytes_ ? std::optional(number) : std::nullopt;
    }
    return {};
}

void FrameCache::read_ahead() {
    std::unique_lock lock(mutex_);
    for (;;) {
        std::optional<std::size_t> next;
        changed_.wait(lock, [&] {
            if (!reading_ && !closing_) next = next_ahead();
            return closing_ || next;
        });
        if (closing_) return;
        try {
            read(lock, *next);
        } catch (...) {
            bad_[*next] = true; // at() tries again and reports the error
        }
    }
}

namespace {

using Json = nlohmann::json;

void add_names(ObjectNames &names, const std::string &manifest) {
    const Json json = Json::parse(manifest, nullptr, false);
    if (!json.is_object()) return;
    for (const auto &[name, id] : json.items())
        if (id.is_string())
            names[std::uint32_t(std::strtoul(id.get_ref<const std::string &>().c_str(), nullptr, 16))] = name;
}

} // namespace

ObjectNames object_names(const Imf::Header &header) {
    ObjectNames names;
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        const std::string name = attribute.name();
        const auto *text = dynamic_cast<const Imf::StringAttribute *>(&attribute.attribute());
        if (text && name.starts_with("cryptomatte/") && name.ends_with("/manifest"))
            add_names(names, text->value());
    }
    return names;
}

DepthExtent depth_extent(const Ldi &ldi) {
    const std::vector<float> &depths = ldi.image_z.empty() ? ldi.z : ldi.image_z;
    if (depths.empty()) return {};
    DepthExtent extent{HUGE_VAL, 0};
    for (const float z : depths) {
        if (!(z > 0)) continue; // rays would meet behind the camera
        extent.nearest = std::min(extent.nearest, double(z));
        extent.farthest = std::max(extent.farthest, double(z));
    }
    return extent.farthest > 0 ? extent : DepthExtent{};
}

Ldi all_rows(const PackedRows &rows) {
    const Imath::Box2i &data = rows.windows().data;
    return rows.rows(data.min.y, data.max.y);
}

Ldi LoadedFrame::row(int y) const { return packed.rows(y, y); }

OpenedLdi LoadedFrame::unpacked() const {
    OpenedLdi all = in;
    all.ldi = all_rows(packed);
    return all;
}

Camera LoadedFrame::camera(const PictureRequest &request) const {
    return picture_camera(request, in, [this](const Imath::V2i &at) { return front_depth(row(at.y), at); });
}

ThinLens LoadedFrame::lens(const PictureRequest &request) const {
    return picture_lens(request, in, camera(request));
}

LoadedFrame pack(OpenedLdi in) {
    PackedRows rows(in.ldi.windows);
    rows.append(in.ldi);
    Ldi bare;
    bare.windows = in.ldi.windows;
    bare.channels = in.ldi.channels;
    in.ldi = std::move(bare);
    return {std::move(in), std::move(rows)};
}

LoadedFrame loaded_frame(OpenedLdi in, const WindowOptions &windows, const ColourOptions &colour) {
    if (!all_found(find_rgb(in.ldi.channels))) throw Error(in.name + ": has no channels R, G and B to show");
    const DepthExtent depths = depth_extent(in.ldi);
    LoadedFrame frame = pack(std::move(in));
    frame.across = subpixels_of(windows, frame.in).across;
    frame.depths = depths;
    frame.names = object_names(frame.in.header);
    frame.to_display = output_transform(colour, frame.in.header);
    return frame;
}

namespace {

// The depth of the nearest sample in the middle of the picture; if there is none, the smallest depth of the picture.
float depth_in_the_middle(const LoadedFrame &frame) {
    const Imath::Box2i &display = frame.in.ldi.windows.display;
    const Imath::V2i at((display.min.x + display.max.x) / 2, (display.min.y + display.max.y) / 2);
    const float z = frame.in.ldi.windows.data.intersects(at) ? front_depth(frame.row(at.y), at) : 0;
    return z > 0 ? z : float(frame.depths.nearest);
}

} // namespace

Words lens_guess(const LoadedFrame &frame, const Camera &camera) {
    const auto radius = lens_radius_of(camera);
    if (radius == 0.0) return {}; // nothing else is needed
    Words words;
    const auto add = [&](const char *option, std::string value) {
        words.push_back(option);
        words.push_back(std::move(value));
    };
    const bool field_known = focal_length_px(camera, frame.in.ldi.windows.display_width()).has_value();
    if (!camera.focal_length_mm && (!field_known || !radius)) add("--focal-length", "50");
    if (!camera.sensor_width_mm && !field_known) add("--sensor-width", "36");
    if (!radius && !camera.fstop) add("--fstop", "2.8");
    if (!camera.focus_distance) add("--focus-distance", fmt::format("{}", depth_in_the_middle(frame)));
    return words;
}

std::string guess_in_words(const Words &guess) {
    std::string text;
    for (std::size_t i = 0; i + 1 < guess.size(); i += 2)
        text += (i ? " " : "") + guess[i] + " " + guess[i + 1];
    return text.empty() ? text
                        : "the file does not say all of its lens; this is a guess to begin with: " + text;
}

} // namespace sparselens
