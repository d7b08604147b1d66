#include "render.h"

#include "asked.h"
#include "describe.h"
#include "flat_source.h"
#include "host.h"
#include "parameter_table.h"
#include "place.h"
#include "settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

namespace sparselens_ofx {

namespace {

struct Scale {
    double x, y;
};
Scale scale_in(OfxPropertySetHandle arguments) {
    const double x = number_in(arguments, kOfxImageEffectPropRenderScale, 0, 1);
    const double y = number_in(arguments, kOfxImageEffectPropRenderScale, 1, 1);
    return x > 0 && y > 0 ? Scale{x, y} : Scale{1, 1};
}

// A picture, and where the host's pixels lie in it.
struct Wanted {
    Question question;
    Header header;
    Place place;
};

Question question_at(OfxImageEffectHandle effect, double time, const std::string &ldi) {
    Question question;
    question.file = ldi;
    question.frame = int(std::lround(time)) + whole_at(effect, offset_parameter, time);
    question.settings = settings_at(effect, time);
    question.settings["channels"] = "rgba";
    question.settings["d"] = "float"; // not rounded twice
    return question;
}

Wanted wanted_of_ldi(Question question, Scale scale) {
    Wanted wanted{std::move(question), {}, {}};
    Header header = ask_header(wanted.question);
    const int proxy = proxy_for(std::max(scale.x, scale.y));
    wanted.place = {header.display, scale.x, scale.y, proxy, 0, 0};
    if (proxy > 1) {
        wanted.question.settings["proxy"] = std::to_string(proxy);
        header = ask_header(wanted.question);
    }
    wanted.header = std::move(header);
    return wanted;
}

// The source is a picture of the render's scale already.
Wanted wanted_of_source(OfxImageEffectHandle effect, Question question, double time, Scale scale) {
    if (!is_connected(effect, source_clip)) throw HostError("name an LDI, or connect a source and its depth");
    if (!is_connected(effect, depth_clip) && !question.settings.contains("depth-file"))
        throw HostError("name an LDI, or connect the depth of the source, or name a file with its depth");
    const FlatSource source = flat_source(effect, time, scale.x, scale.y);
    question.flat = source.picture;
    if (source.unpremultiplied) question.settings["unpremultiplied"] = "true";
    Wanted wanted{std::move(question), {}, {}};
    wanted.header = ask_header(wanted.question);
    wanted.place = {source.picture->display, 1, 1, 1, source.display.x1, source.display.y1};
    return wanted;
}

// R, G, B and A of the picture's pixels in a box; 0 beyond the picture.
class Pixels {
public:
    Pixels(const Wanted &wanted, const Box &needed) : box_(intersection(needed, wanted.header.data)) {
        if (!box_.is_empty()) values_ = ask_pixels(wanted.question, wanted.header, box_);
    }
    std::array<float, 4> at(int x, int y) const {
        if (x < box_.x0 || x > box_.x1 || y < box_.y0 || y > box_.y1) return {};
        const std::size_t width = std::size_t(box_.x1 - box_.x0 + 1);
        const float *pixel = &values_[4 * (std::size_t(y - box_.y0) * width + std::size_t(x - box_.x0))];
        return {pixel[0], pixel[1], pixel[2], pixel[3]};
    }

private:
    Box box_;
    std::vector<float> values_;
};

// Converts a pixel of the picture, which is premultiplied, to the components of the image.
std::array<float, 4> in_image(std::array<float, 4> rgba, const HostImage &image) {
    const float alpha = rgba[3];
    if (image.format.components == 1) return {alpha};
    if (image.format.components == 4 && image.unpremultiplied && alpha > 0)
        for (int k = 0; k < 3; ++k) rgba[std::size_t(k)] /= alpha;
    return rgba;
}

void write_window(const Pixels &pixels, const Place &place, const Rectangle &window, const HostImage &image) {
    for (int y = window.y1; y < window.y2; ++y) {
        const int row = place.row(y);
        for (int x = window.x1; x < window.x2; ++x)
            write_pixel(image.format, in_image(pixels.at(place.column(x), row), image).data(),
                        image.pixel(x, y));
    }
}

bool is_sequence(const std::string &name) { return name.find_first_of("#%") != std::string::npos; }

double output_aspect(OfxImageEffectHandle effect) {
    OfxPropertySetHandle properties = nullptr;
    if (!clip_of(effect, output_clip, &properties)) return 1;
    const double aspect = number_in(properties, kOfxImagePropPixelAspectRatio, 0, 1);
    return aspect > 0 ? aspect : 1;
}

void set_region(OfxPropertySetHandle result, const std::string &name, const OfxRectD &region) {
    const std::array<double, 4> sides{region.x1, region.y1, region.x2, region.y2};
    for (int i = 0; i < 4; ++i) set(result, name.c_str(), sides[std::size_t(i)], i);
}

} // namespace

OfxStatus render(OfxImageEffectHandle effect, OfxPropertySetHandle arguments) {
    const double time = number_in(arguments, kOfxPropTime, 0, 0);
    const Scale scale = scale_in(arguments);
    const HostImage image = host_image(effect, output_clip, time);
    const Rectangle window =
        intersection(rectangle_in(arguments, kOfxImageEffectPropRenderWindow), image.bounds);
    if (window.is_empty() || suites().effects->abort(effect)) return kOfxStatOK;
    const std::string ldi = text_at(effect, ldi_parameter, time);
    Question question = question_at(effect, time, ldi);
    question.shown = image.format.is_whole();
    // The questions of one render follow each other, so that the gatherer does not read two LDIs by turns.
    static std::mutex turn;
    const std::lock_guard lock(turn);
    const Wanted wanted = ldi.empty() ? wanted_of_source(effect, std::move(question), time, scale)
                                      : wanted_of_ldi(std::move(question), scale);
    const Place &place = wanted.place;
    const Pixels pixels(wanted, {place.column(window.x1), place.row(window.y2 - 1),
                                 place.column(window.x2 - 1), place.row(window.y1)});
    write_window(pixels, place, window, image);
    return kOfxStatOK;
}

OfxStatus region_of_definition(OfxImageEffectHandle effect, OfxPropertySetHandle arguments,
                               OfxPropertySetHandle result) {
    const double time = number_in(arguments, kOfxPropTime, 0, 0);
    const std::string ldi = text_at(effect, ldi_parameter, time);
    if (ldi.empty() || whole_in(suites().host, kOfxImageEffectPropSupportsMultiResolution, 0, 0) == 0)
        return kOfxStatReplyDefault;
    const Header header = ask_header(question_at(effect, time, ldi));
    const double aspect = output_aspect(effect);
    const Box &data = header.data, &display = header.display;
    set_region(result, kOfxImageEffectPropRegionOfDefinition,
               {(data.x0 - display.x0) * aspect, double(display.y1 - data.y1),
                (data.x1 + 1 - display.x0) * aspect, double(display.y1 + 1 - data.y0)});
    return kOfxStatOK;
}

OfxStatus regions_of_interest(OfxImageEffectHandle effect, OfxPropertySetHandle arguments,
                              OfxPropertySetHandle result) {
    const double time = number_in(arguments, kOfxPropTime, 0, 0);
    if (!text_at(effect, ldi_parameter, time).empty()) return kOfxStatReplyDefault;
    for (const char *name : {source_clip, depth_clip}) {
        const OfxImageClipHandle clip = is_connected(effect, name) ? clip_of(effect, name) : nullptr;
        OfxRectD all{};
        if (clip && suites().effects->clipGetRegionOfDefinition(clip, time, &all) == kOfxStatOK)
            set_region(result, std::string("OfxImageClipPropRoI_") + name, all);
    }
    return kOfxStatOK;
}

OfxStatus clip_preferences(OfxImageEffectHandle effect, OfxPropertySetHandle result) {
    if (!is_sequence(text_at(effect, ldi_parameter, 0))) return kOfxStatReplyDefault;
    set(result, kOfxImageEffectFrameVarying, 1);
    return kOfxStatOK;
}

} // namespace sparselens_ofx
