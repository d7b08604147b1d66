#include "viewing/lens_guess.h"

#include "deep/front_samples.h"

#include <fmt/format.h>

namespace sparselens {

namespace {

// The depth of the nearest sample in the middle of the picture; if there is none, the smallest depth of the picture.
float depth_in_the_middle(const ShotFrame &frame) {
    const Imath::Box2i &display = frame.in.ldi.windows.display;
    const Imath::V2i at((display.min.x + display.max.x) / 2, (display.min.y + display.max.y) / 2);
    const float z = frame.in.ldi.windows.data.intersects(at) ? front_depth(frame.row(at.y), at) : 0;
    return z > 0 ? z : float(frame.depths.nearest);
}

} // namespace

Words lens_guess(const ShotFrame &frame, const Camera &camera) {
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
