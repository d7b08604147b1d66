#include "chain/colours.h"

#include "base/error.h"
#include "deep/packed_view.h"
#include "io/display/shown_picture.h"
#include "io/display/stated_space.h"
#include "io/exr/exr_flat.h"
#include "io/files/file_stream.h"

#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <mutex>
#include <optional>

namespace sparselens {

namespace {

bool is_pipe(const std::string &path) { return path == "-" || path == display_name("-"); }

// The configuration; empty if $OCIO names one that cannot be read and it is needed for a guess only.
std::optional<ColourConfig> config_if_readable(const Tell &tell, const ColourOptions &options) {
    try {
        return ColourConfig(options.config);
    } catch (const Error &error) {
        if (!options.config.empty() || !options.input_space.empty()) throw;
        static std::once_flag said; // once for all files
        std::call_once(said, [&] {
            tell({.kind = NoticeKind::no_colorconfig, .values = {error.what()}, .parameter = "colorconfig"});
        });
        return {};
    }
}

struct LinearColours {
    Imf::Header header;                            // states their colour space
    std::optional<ColourTransform> transform = {}; // into that space; empty: nothing to do
};

LinearColours linear_colours(const Tell &tell, const ColourOptions &options, const std::string &path,
                             const Imf::Header &header) {
    const bool says = states_space(header), asked = !options.input_space.empty();
    const bool ours = header.findTypedAttribute<Imf::StringAttribute>("sparselens:version") != nullptr;
    if (!asked && !says && (ours || is_pipe(path))) return {header};
    const std::optional<ColourConfig> readable = config_if_readable(tell, options);
    if (!readable) return {header};
    const ColourConfig &config = *readable;
    std::string from = options.input_space;
    if (const auto stated = stated_space(config, header); stated && !asked) {
        if (!stated->space) {
            tell({stated->attribute == "chromaticities" ? NoticeKind::unnamed_chromaticities
                                                        : NoticeKind::unnamed_space,
                  display_name(path),
                  {stated->attribute},
                  "colorspace"});
            return {header};
        }
        from = *stated->space;
    }
    if (from.empty()) from = config.space_of_file(path);
    tell({NoticeKind::colour_space, display_name(path), {from}});
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
    if (!Imf::hasChromaticities(header)) return config.scene_linear();
    return config.linear_space(Imf::chromaticities(header)).value_or(config.scene_linear());
}

ColourTransform output_transform(const ColourConfig &config, const ColourOptions &options,
                                 const std::string &from) {
    return options.output_space.empty() ? config.to_display(options.display, options.view, from)
                                        : config.between(from, options.output_space);
}

} // namespace

Imf::Header to_linear(const Tell &tell, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, Ldi &ldi) {
    LinearColours to = linear_colours(tell, options, path, header);
    const std::vector<std::span<float>> planes(ldi.values.begin(), ldi.values.end());
    if (to.transform) transform_colours(*to.transform, ldi.channels, planes);
    return std::move(to.header);
}

bool is_linear(const Tell &tell, const ColourOptions &options, const std::string &path,
               const Imf::Header &header) {
    return !linear_colours(tell, options, path, header).transform;
}

Imf::Header to_linear(const Tell &tell, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, PackedView &view) {
    LinearColours to = linear_colours(tell, options, path, header);
    if (!to.transform) return std::move(to.header);
    if (view.samples.deep()) {
        Ldi samples = view.samples.as_ldi();
        samples.weight = {};
        const std::vector<std::span<float>> planes(samples.values.begin(), samples.values.end());
        transform_colours(*to.transform, samples.channels, planes);
        view.samples = ViewSamples(std::move(samples));
        return std::move(to.header);
    }
    View whole = unpacked(view);
    transform_colours(*to.transform, whole.image);
    view = PackedView(std::move(whole));
    return std::move(to.header);
}

Imf::Header to_linear(const Tell &tell, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, Image &image) {
    LinearColours to = linear_colours(tell, options, path, header);
    if (to.transform) transform_colours(*to.transform, image);
    return std::move(to.header);
}

ColourTransform output_transform(const ColourOptions &options, const Imf::Header &metadata) {
    const ColourConfig config(options.config);
    return output_transform(config, options, space_of(config, metadata));
}

namespace {

void to_output_space(const ColourOptions &options, Image &image, Imf::Header &header) {
    const ColourConfig config(options.config);
    transform_colours(output_transform(config, options, space_of(config, header)), image);
    header = with_space(config, header, options.output_space);
}

} // namespace

void to_exr_space(const ColourOptions &options, const std::string &path, Image &image, Imf::Header &header) {
    if (!(options.display.empty() && options.view.empty()))
        throw UsageError("`display` and `view_transform` apply to PNG, JPEG and TIFF, not to " + path);
    if (!options.output_space.empty()) to_output_space(options, image, header);
}

std::size_t write_picture(const Tell &tell, const ColourOptions &options, const std::string &path,
                          Image image, const Imf::Header &metadata,
                          std::optional<Imf::Compression> compression, int tiles) {
    Imf::Header header = metadata;
    if (!is_shown_picture(path)) {
        to_exr_space(options, path, image, header);
        return write_flat_exr(path, image, header, compression, tiles);
    }
    if (compression) throw UsageError("`compression` applies to EXR, not to " + path);
    if (tiles > 0) throw UsageError("`tiles` applies to EXR, not to " + path);
    to_output_space(options, image, header);
    write_shown_picture(path, image);
    tell({NoticeKind::displayed, path});
    return 0;
}

} // namespace sparselens
