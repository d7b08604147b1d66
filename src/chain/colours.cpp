#include "chain/colours.h"

#include "base/error.h"
#include "chain/make_ldi.h"
#include "deep/recolor.h"
#include "deep/sanitize.h"
#include "deep/view_samples.h"
#include "io/camera/camera_header.h"
#include "io/display/icc_profile.h"
#include "io/exr/exr_common.h"
#include "io/files/file_stream.h"
#include "io/photograph.h"
#include "lens/thin_lens.h"

#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <utility>

namespace sparselens {

namespace {

bool is_pipe(const std::string &path) { return path == "-" || path == display_name("-"); }

// The configuration; empty if $OCIO names one that cannot be read, or has no scene-linear space, and it is needed for a
// guess only.
std::optional<ColourConfig> config_if_readable(const Notify &notify, const ColourOptions &options) {
    try {
        ColourConfig config(options.config);
        if (options.config.empty() && options.input_space.empty()) (void)config.scene_linear();
        return config;
    } catch (const Error &error) {
        if (!options.config.empty() || !options.input_space.empty()) throw;
        static std::once_flag said; // once for all files
        std::call_once(said, [&] {
            notify(
                {.kind = NoticeKind::no_colorconfig, .values = {error.what()}, .parameter = "colorconfig"});
        });
        return {};
    }
}

struct LinearColours {
    Imf::Header header;                            // states their colour space
    std::optional<ColourTransform> transform = {}; // into that space; empty: nothing to do
};

// Photographs come in their own encoding, and go back to it, whatever the configuration: sRGB, or that of their profile.
LinearColours of_photograph(const Imf::Header &header, const ShownExtras &extras) {
    const ColourConfig config = ColourConfig::built_in();
    LinearColours result{with_space(config, header, config.scene_linear()),
                         transform_of_profile(extras.profile, ProfileDirection::to_linear)};
    if (!result.transform) result.transform = config.between("sRGB", config.scene_linear());
    return result;
}

LinearColours linear_colours(const Notify &notify, const ColourOptions &options, const std::string &path,
                             const Imf::Header &stated_header) {
    if (const auto extras = extras_of(stated_header);
        extras && options.config.empty() && options.input_space.empty()) {
        notify({NoticeKind::colour_space,
                display_name(path),
                {extras->profile.empty() ? "sRGB" : "of its profile"}});
        return of_photograph(stated_header, *extras);
    }
    const Imf::Header header = without_extras(stated_header);
    const bool says = states_space(header), asked = !options.input_space.empty();
    const bool ours = header.findTypedAttribute<Imf::StringAttribute>("sparselens:version") != nullptr;
    if (!asked && !says && (ours || is_pipe(path))) return {header};
    const std::optional<ColourConfig> readable = config_if_readable(notify, options);
    if (!readable) return {header};
    const ColourConfig &config = *readable;
    std::string from = options.input_space;
    if (const auto stated = stated_space(config, header); stated && !asked) {
        if (!stated->space) {
            notify({stated->attribute == "chromaticities" ? NoticeKind::unnamed_chromaticities
                                                          : NoticeKind::unnamed_space,
                    display_name(path),
                    {stated->attribute},
                    "colorspace"});
            return {header};
        }
        from = *stated->space;
    }
    if (from.empty()) from = config.space_of_file(path);
    notify({NoticeKind::colour_space, display_name(path), {from}});
    const auto own = config.chromaticities_of(from);
    const std::string to = own ? from : config.scene_linear();
    // OpenEXR defines that a file without the attribute has Rec.709 primaries, so Rec.709 need not be stated.
    const bool silent =
        own && !asked && !says && config.linear_space({}) == from && config.scene_linear() == from;
    LinearColours result{silent ? header : with_space(config, header, to)};
    if (!own) result.transform = config.between(from, to);
    return result;
}

// The space of pixels that went through to_linear(), or that have never been in a file.
std::string space_of(const ColourConfig &config, const Imf::Header &header) {
    const auto stated = stated_space(config, header);
    return stated && stated->space ? *stated->space : config.scene_linear();
}

} // namespace

Imf::Header to_linear(const Notify &notify, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, Ldi &ldi) {
    LinearColours to = linear_colours(notify, options, path, header);
    if (to.transform) transform_colours(*to.transform, ldi.channels, planes_of(ldi));
    return std::move(to.header);
}

bool is_linear(const Notify &notify, const ColourOptions &options, const std::string &path,
               const Imf::Header &header) {
    return !linear_colours(notify, options, path, header).transform;
}

Imf::Header to_linear(const Notify &notify, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, PackedView &view) {
    LinearColours to = linear_colours(notify, options, path, header);
    if (!to.transform) return std::move(to.header);
    if (view.samples.deep()) {
        Ldi samples = view.samples.as_ldi();
        samples.weight = {};
        transform_colours(*to.transform, samples.channels, planes_of(samples));
        view.samples = ViewSamples(std::move(samples));
        return std::move(to.header);
    }
    View whole = unpacked(view);
    transform_colours(*to.transform, whole.image);
    view = PackedView(std::move(whole));
    return std::move(to.header);
}

Imf::Header to_linear(const Notify &notify, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, Image &image) {
    LinearColours to = linear_colours(notify, options, path, header);
    if (to.transform) transform_colours(*to.transform, image);
    return std::move(to.header);
}

bool same_chromaticities(const Imf::Header &a, const Imf::Header &b) {
    const bool stated = Imf::hasChromaticities(a);
    if (stated != Imf::hasChromaticities(b)) return false;
    return !stated || same_chromaticities(Imf::chromaticities(a), Imf::chromaticities(b));
}

void to_space_of(const Notify &notify, const ColourOptions &options, const NamedHeader &wanted,
                 const NamedHeader &stated, Image &image) {
    if (same_chromaticities(wanted.header, stated.header)) return;
    notify({NoticeKind::converted, stated.name, {wanted.name}});
    const ColourConfig config(options.config);
    transform_colours(config.between(space_of(config, stated.header), space_of(config, wanted.header)),
                      image);
}

namespace {

// A picture made from a photograph keeps these of its file, unless another encoding is asked for.
std::optional<ShownExtras> kept_extras(const ColourOptions &options, const Imf::Header &metadata) {
    if (!(options.config + options.output_space + options.display + options.view).empty()) return {};
    return extras_of(metadata);
}

} // namespace

ColourTransform output_transform(const ColourOptions &options, const Imf::Header &metadata) {
    const ColourConfig config =
        kept_extras(options, metadata) ? ColourConfig::built_in() : ColourConfig(options.config);
    const std::string from = space_of(config, metadata);
    return options.output_space.empty() ? config.to_display(options.display, options.view, from)
                                        : config.between(from, options.output_space);
}

void to_exr_space(const ColourOptions &options, const std::string &path, Image &image, Imf::Header &header) {
    if (!(options.display.empty() && options.view.empty()))
        throw UsageError("`display` and `view_transform` apply to PNG, JPEG and TIFF, not to " + path);
    if (options.output_space.empty()) return;
    const ColourConfig config(options.config);
    transform_colours(config.between(space_of(config, header), options.output_space), image);
    header = with_space(config, header, options.output_space);
}

std::optional<ShownExtras> to_shown_colours(const ColourOptions &options, const std::string &path,
                                            Image &image, const Imf::Header &metadata) {
    if (holds_linear_light(path) && (options.output_space + options.display + options.view).empty())
        return {};
    const std::optional<ShownExtras> kept = kept_extras(options, metadata);
    const auto own = kept ? transform_of_profile(kept->profile, ProfileDirection::from_linear) : std::nullopt;
    transform_colours(own ? *own : output_transform(options, metadata), image);
    return kept.value_or(ShownExtras());
}

void write_picture(const Notify &notify, const ColourOptions &options, const std::string &path, Image image,
                   const Imf::Header &metadata, std::optional<Imf::Compression> compression, int tiles) {
    Imf::Header header = metadata;
    if (!is_shown_picture(path)) {
        to_exr_space(options, path, image, header);
        if (compression)
            if (const std::string channel = data_changed_by(*compression, image.channels); !channel.empty())
                notify({NoticeKind::changed_data, path, {channel}, "compression"});
        return notify_clamped(notify, path, write_flat_exr(path, image, header, compression, tiles));
    }
    if (compression) throw UsageError("`compression` applies to EXR, not to " + path);
    if (tiles > 0) throw UsageError("`tiles` applies to EXR, not to " + path);
    if (drop_unwritten_coverage(path, image) && extras_of(header)) notify({NoticeKind::dropped_alpha, path});
    const std::optional<ShownExtras> extras = to_shown_colours(options, path, image, header);
    if (extras) notify({NoticeKind::displayed, path});
    write_shown_picture(path, image, extras.value_or(ShownExtras()));
}

namespace {

// Drops everything else, such as depths at infinity.
Image light_and_coverage(const Image &image) {
    std::vector<Channel> kept;
    std::ranges::copy_if(image.channels, std::back_inserter(kept), is_light);
    Image result(image.windows, kept);
    for (std::size_t k = 0; k < kept.size(); ++k)
        std::ranges::copy(image.plane(find_channel(image.channels, kept[k].name)), result.plane(k).begin());
    return result;
}

struct FlatLight {
    std::string name; // of the file, for messages
    Image image;      // light and coverage only: valid values
    Imf::Header header;
};

// `colour` says how its colours are made linear; null: they are linear. `path` is for messages.
FlatLight light_of(FlatFile file, const std::string &path, const ColourOptions *colour,
                   const Notify &notify) {
    const std::string name = display_name(path);
    // Every pixel is placed in front of the camera, so that its values are repaired like those of a view.
    View view{name, light_and_coverage(file.image), {}};
    view.z.assign(view.image.windows.pixels(), 1);
    const InvalidValues bad = sanitize(view);
    notify_reading(notify, name, file.notes, file.warnings);
    notify_invalid_values(notify, name, bad);
    FlatLight light{name, std::move(view.image), std::move(file.header)};
    if (colour) light.header = to_linear(notify, *colour, path, light.header, light.image);
    return light;
}

// Reads a flat EXR. `choice` is that of the picture to which it belongs, except for its depth.
FlatFile read_partner(const std::string &path, PictureChoice choice, const Notify &notify) {
    notify({NoticeKind::reading, path});
    choice.depth.clear();
    choice.depth_file.clear();
    return read_flat_exr(path, choice);
}

void check_count(std::size_t denoised, std::size_t views) {
    if (denoised != views)
        throw UsageError(fmt::format(
            "`denoised`: there are {} of them for {} views; give one for each, in the order of the views",
            denoised, views));
}

// The pictures from files, then those in memory, whose colours are linear.
std::vector<DenoisedPicture> pictures_of(const LdiFromViews &request, const Notify &notify) {
    const ColourOptions *colour = request.colour ? &*request.colour : nullptr;
    std::vector<DenoisedPicture> pictures;
    for (const std::string &path : request.denoised)
        pictures.push_back(
            {path, light_of(read_partner(path, request.depth.picture, notify), path, colour, notify).image});
    for (const DenoisedPicture &picture : request.denoised_pictures) {
        FlatFile file;
        file.image = picture.image;
        pictures.push_back({picture.name, light_of(std::move(file), picture.name, nullptr, notify).image});
    }
    return pictures;
}

} // namespace

void take_denoised(const LdiFromViews &request, const WarpOptions &by, std::vector<PackedView> &views,
                   const Notify &notify) {
    std::vector<DenoisedPicture> denoised = pictures_of(request, notify);
    if (!denoised.empty()) check_count(denoised.size(), views.size());
    if (!request.noisy.empty())
        for (PackedView &view : views) denoised.push_back(part_denoised(view, request.noisy));
    if (!denoised.empty())
        take_denoised(views, denoised, by.focal_px, disparity_scale(by.radius, by.focal_px));
}

namespace {

void require_colours(std::span<const Channel> channels, const std::string &name) {
    for (std::size_t k = 0; k < channels.size(); ++k)
        if (is_recolored(channels, k)) return;
    throw Error(name + ": has no colours; give a picture with R, G and B (`recolor`)");
}

void require_one_frame(const OpenedLdi &ldi, const FlatLight &beauty) {
    const Windows &deep = ldi.ldi.windows, &flat = beauty.image.windows;
    if (deep.display != flat.display)
        throw Error(
            fmt::format("{}: its display window differs from that of {}; give the picture of the same "
                        "frame and size (`recolor`)",
                        beauty.name, ldi.name));
    if (deep.pixel_aspect != flat.pixel_aspect)
        throw Error(fmt::format("{}: its pixel aspect ratio is {:g}, that of {} is {:g}; give the picture of "
                                "the same camera (`recolor`)",
                                beauty.name, flat.pixel_aspect, ldi.name, deep.pixel_aspect));
    if (!deep.data.intersects(flat.data))
        throw Error(
            fmt::format("{}: its data window has no pixel in common with that of {}; give the picture "
                        "of the same frame (`recolor`)",
                        beauty.name, ldi.name));
}

// The names that channels get in files: those of light as in the beauty, the others as in the deep file.
KeptNames kept_names(const std::vector<Channel> &channels, const Imf::Header &deep, const Imf::Header &flat) {
    const std::vector<Channel> of_deep = by_kept_names(channels, deep),
                               of_flat = by_kept_names(channels, flat);
    KeptNames kept;
    for (std::size_t k = 0; k < channels.size(); ++k) {
        const std::string &name = (is_recolored(channels, k) ? of_flat : of_deep)[k].name;
        if (name != channels[k].name) kept[channels[k].name] = name;
    }
    return kept;
}

void notify_recolored(const Recolored &made, const std::string &deep, const FlatLight &beauty,
                      const Notify &notify) {
    if (made.differ > 0)
        notify(
            {NoticeKind::coverage_differs, beauty.name, {deep, made.differ, beauty.image.windows.pixels()}});
    if (made.beyond > 0) notify({NoticeKind::without_colours, beauty.name, {deep, made.beyond}});
    if (made.infinite > 0) notify({NoticeKind::light_at_infinity, beauty.name, {made.infinite}});
}

} // namespace

void recolor_by(FlatFile file, const std::string &path, const ColourOptions *colour, OpenedLdi &ldi,
                const Notify &notify) {
    const FlatLight beauty = light_of(std::move(file), path, colour, notify);
    require_colours(beauty.image.channels, beauty.name);
    require_one_frame(ldi, beauty);
    Recolored made = recolor(std::move(ldi.ldi), beauty.image);
    ldi.ldi = std::move(made.ldi);
    ldi.samples_read = ldi.ldi.samples();
    const KeptNames names = kept_names(ldi.ldi.channels, ldi.header, beauty.header);
    ldi.header = with_space_of(beauty.header, ldi.header);
    set_kept_names(ldi.header, names);
    ldi.header.dataWindow() = ldi.ldi.windows.data;
    write_picture_window(ldi.header, ldi.ldi.windows.data);
    notify_recolored(made, ldi.name, beauty, notify);
    notify_layers(notify, beauty.name, ldi.ldi.channels);
}

void recolor_by(const std::string &path, const PictureChoice &choice, const ColourOptions &colour,
                OpenedLdi &ldi, const Notify &notify) {
    if (!path.empty()) recolor_by(read_partner(path, choice, notify), path, &colour, ldi, notify);
}

} // namespace sparselens
