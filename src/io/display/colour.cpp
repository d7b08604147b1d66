#include "io/display/colour.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "io/display/default_ocio_config.h"
#include "io/exr/exr_header.h"

#include <ImfChromaticitiesAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace sparselens {

namespace ocio = OCIO_NAMESPACE;

struct ColourTransform::Processor {
    ocio::ConstCPUProcessorRcPtr cpu;
};

struct ColourConfig::Impl {
    std::string name; // for messages
    ocio::ConstConfigRcPtr config;
};

namespace {

// Uses the exact curves. Versions after 2.1 approximate powers by default: sRGB's is 7e-5 off at 2.
ocio::ConstCPUProcessorRcPtr exactly(const ocio::Processor &processor) {
    return processor.getOptimizedCPUProcessor(
        ocio::OptimizationFlags(ocio::OPTIMIZATION_DEFAULT & ~ocio::OPTIMIZATION_FAST_LOG_EXP_POW));
}

std::string first_line(const std::string &text) { return text.substr(0, text.find('\n')); }

// Turns exceptions of OpenColorIO into an Error that names the configuration.
template <typename Work>
auto with_config_name(const std::string &name, const Work &work) {
    try {
        return work();
    } catch (const ocio::Exception &error) {
        throw Error(name + ": " + first_line(error.what()));
    }
}

ocio::ConstConfigRcPtr config_of(const std::string &file) {
    if (!file.empty()) return ocio::Config::CreateFromFile(file.c_str());
    std::istringstream text(default_ocio_config());
    return ocio::Config::CreateFromStream(text);
}

// Throws Error, with the list of existing names, if no space, display or view has that name.
void expect_name(const std::string &config, const std::string &name, const std::string &what,
                 const std::vector<std::string> &there) {
    if (is_among(there, name)) return;
    throw Error(fmt::format("{}: has no {} '{}', only {}", config, what, name, fmt::join(there, ", ")));
}

std::vector<std::string> spaces_of(const ocio::Config &config) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumColorSpaces(); ++i)
        names.emplace_back(config.getColorSpaceNameByIndex(i));
    return names;
}

// Linear spaces by their primaries (ITU-R BT.709 and BT.2020, SMPTE RP 431-2 with D65, S-2014-004 and ST 2065-1 of the
// Academy), their ids of the Color Interop Forum, and the names that the configurations of OpenColorIO, the Academy and
// Blender give them.
struct LinearSpace {
    Imf::Chromaticities chromaticities;
    const char *interop_id;
    std::vector<const char *> names;
};

const std::vector<LinearSpace> &linear_spaces() {
    using V = Imath::V2f;
    static const V d65(0.3127f, 0.3290f), aces_white(0.32168f, 0.33767f);
    static const std::vector<LinearSpace> spaces{
        {{V(0.64f, 0.33f), V(0.30f, 0.60f), V(0.15f, 0.06f), d65},
         "lin_rec709_scene",
         {"lin_rec709", "Linear Rec.709", "Linear Rec.709 (sRGB)", "lin_rec709_srgb", "lin_srgb",
          "Utility - Linear - sRGB", "Utility - Linear - Rec.709"}},
        {{V(0.713f, 0.293f), V(0.165f, 0.830f), V(0.128f, 0.044f), aces_white},
         "lin_ap1_scene",
         {"ACEScg", "lin_ap1", "ACES - ACEScg"}},
        {{V(0.7347f, 0.2653f), V(0, 1), V(0.0001f, -0.0770f), aces_white},
         "lin_ap0_scene",
         {"ACES2065-1", "lin_ap0", "ACES - ACES2065-1"}},
        {{V(0.708f, 0.292f), V(0.170f, 0.797f), V(0.131f, 0.046f), d65},
         "lin_rec2020_scene",
         {"lin_rec2020", "Linear Rec.2020", "Utility - Linear - Rec.2020"}},
        {{V(0.680f, 0.320f), V(0.265f, 0.690f), V(0.150f, 0.060f), d65},
         "lin_p3d65_scene",
         {"lin_p3d65", "Linear P3-D65"}}};
    return spaces;
}

// The name that the configuration itself gives to the space, if it has it.
std::optional<std::string> own_name(const ocio::Config &config, const std::string &name) {
    const auto space = config.getColorSpace(name.c_str());
    if (!space) return {};
    return space->getName();
}

// The id that a space has in the configuration itself.
std::string configured_id(const ocio::ColorSpace &space) {
#if OCIO_VERSION_HEX >= 0x02050000
    return space.getInteropID();
#else
    (void)space;
    return {};
#endif
}

std::optional<std::string> first_own_name(const ocio::Config &config, const LinearSpace &space) {
    for (const char *name : space.names)
        if (const auto own = own_name(config, name)) return own;
    return {};
}

} // namespace

bool ColourTransform::changes_nothing() const { return processor_->cpu->isNoOp(); }

void ColourTransform::apply(std::span<float> r, std::span<float> g, std::span<float> b,
                            const float *a) const {
    constexpr std::size_t run = 4096;
    parallel_ranges(r.size(), run, [&](std::size_t from, std::size_t to) {
        std::vector<float> rgb(3 * (to - from));
        const auto coverage = [&](std::size_t i) { return a && a[i] > 0 ? a[i] : 1; };
        for (std::size_t i = from; i < to; ++i) {
            float *pixel = &rgb[3 * (i - from)];
            pixel[0] = r[i] / coverage(i), pixel[1] = g[i] / coverage(i), pixel[2] = b[i] / coverage(i);
        }
        ocio::PackedImageDesc pixels(rgb.data(), long(to - from), 1, 3);
        processor_->cpu->apply(pixels);
        for (std::size_t i = from; i < to; ++i) {
            const float *pixel = &rgb[3 * (i - from)];
            r[i] = pixel[0] * coverage(i), g[i] = pixel[1] * coverage(i), b[i] = pixel[2] * coverage(i);
        }
    });
}

ColourTransform ColourTransform::of(const CurvesAndMatrix &made, bool inverse) {
    const auto count = static_cast<unsigned long>(made.curves[0].size()); // of 32 bits in Windows
    const auto lines = ocio::Lut1DTransform::Create(count, false);
    lines->setInterpolation(ocio::INTERP_LINEAR);
    for (unsigned long i = 0; i < count; ++i)
        lines->setValue(i, made.curves[0][i], made.curves[1][i], made.curves[2][i]);
    const auto matrix = ocio::MatrixTransform::Create();
    std::array<double, 16> rows{};
    rows[15] = 1;
    for (std::size_t to = 0; to < 3; ++to)
        for (std::size_t from = 0; from < 3; ++from) rows[4 * to + from] = made.matrix[int(from)][int(to)];
    matrix->setMatrix(rows.data());
    const auto both = ocio::GroupTransform::Create();
    both->appendTransform(lines);
    both->appendTransform(matrix);
    const auto direction = inverse ? ocio::TRANSFORM_DIR_INVERSE : ocio::TRANSFORM_DIR_FORWARD;
    const auto processor = ocio::Config::CreateRaw()->getProcessor(both, direction);
    ColourTransform transform; // the faster inverse of curves is coarse
    transform.processor_ = std::make_shared<const Processor>(
        Processor{processor->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS)});
    return transform;
}

ColourConfig ColourConfig::built_in() {
    return ColourConfig(
        std::make_shared<const Impl>(Impl{"the built-in colour configuration", config_of({})}));
}

ColourConfig::ColourConfig(const std::string &file) {
    const char *variable = std::getenv("OCIO");
    const std::string path = !file.empty() ? file : variable ? variable : "";
    const std::string name = path.empty()   ? "the built-in colour configuration"
                             : file.empty() ? path + " ($OCIO)"
                                            : path + " (`colorconfig`)";
    const bool is_file = !path.empty() && !path.starts_with("ocio://"); // otherwise OpenColorIO's own
    if (is_file && !std::filesystem::is_regular_file(path)) throw Error(name + ": no such file");
    impl_ = with_config_name(name, [&] { return std::make_shared<const Impl>(Impl{name, config_of(path)}); });
}

std::string ColourConfig::scene_linear() const {
    const auto space = impl_->config->getColorSpace(ocio::ROLE_SCENE_LINEAR);
    if (!space) throw Error(impl_->name + ": has no role scene_linear");
    return space->getName();
}

std::string ColourConfig::space_of_file(const std::string &path) const {
    return with_config_name(impl_->name, [&]() -> std::string {
        const char *name = impl_->config->getColorSpaceFromFilepath(path.c_str());
        const auto space = impl_->config->getColorSpace(name); // a rule may name a role
        return space ? space->getName() : name;
    });
}

ColourTransform ColourConfig::between(const std::string &from, const std::string &to) const {
    return with_config_name(impl_->name, [&] {
        for (const std::string &name : {from, to})
            if (!impl_->config->getColorSpace(name.c_str()))
                expect_name(impl_->name, name, "colour space", spaces_of(*impl_->config));
        ColourTransform transform;
        const auto processor = impl_->config->getProcessor(from.c_str(), to.c_str());
        transform.processor_ = std::make_shared<const ColourTransform::Processor>(
            ColourTransform::Processor{exactly(*processor)});
        return transform;
    });
}

bool same_chromaticities(const Imf::Chromaticities &a, const Imf::Chromaticities &b) {
    constexpr float rounding = 1e-3f;
    return a.red.equalWithAbsError(b.red, rounding) && a.green.equalWithAbsError(b.green, rounding) &&
           a.blue.equalWithAbsError(b.blue, rounding) && a.white.equalWithAbsError(b.white, rounding);
}

std::optional<std::string> ColourConfig::linear_space(const Imf::Chromaticities &chromaticities) const {
    for (const LinearSpace &space : linear_spaces())
        if (same_chromaticities(space.chromaticities, chromaticities))
            return first_own_name(*impl_->config, space);
    return {};
}

std::optional<Imf::Chromaticities> ColourConfig::chromaticities_of(const std::string &space) const {
    const auto asked = own_name(*impl_->config, space);
    if (!asked) return {};
    for (const LinearSpace &linear : linear_spaces())
        for (const char *name : linear.names)
            if (own_name(*impl_->config, name) == asked) return linear.chromaticities;
    return {};
}

std::optional<std::string> ColourConfig::space_named(const std::string &name_or_id) const {
    const ocio::Config &config = *impl_->config;
    if (name_or_id.empty()) return {};
    if (const auto own = own_name(config, name_or_id)) return own;
    for (int i = 0; i < config.getNumColorSpaces(); ++i) {
        const auto space = config.getColorSpace(config.getColorSpaceNameByIndex(i));
        if (configured_id(*space) == name_or_id) return space->getName();
    }
    for (const LinearSpace &space : linear_spaces())
        if (space.interop_id == name_or_id) return first_own_name(config, space);
    return {};
}

std::string ColourConfig::interop_id(const std::string &space) const {
    const auto asked = impl_->config->getColorSpace(space.c_str());
    if (!asked) return {};
    const std::string configured = configured_id(*asked);
    if (!configured.empty()) return configured;
    for (const LinearSpace &linear : linear_spaces())
        if (first_own_name(*impl_->config, linear) == asked->getName()) return linear.interop_id;
    return {};
}

ColourTransform ColourConfig::to_display(const std::string &display, const std::string &view,
                                         const std::string &from) const {
    const ocio::Config &config = *impl_->config;
    return with_config_name(impl_->name, [&] {
        const std::string on = display.empty() ? config.getDefaultDisplay() : display;
        std::vector<std::string> displays, views;
        for (int i = 0; i < config.getNumDisplays(); ++i) displays.emplace_back(config.getDisplay(i));
        expect_name(impl_->name, on, "display", displays);
        const std::string through = view.empty() ? config.getDefaultView(on.c_str()) : view;
        for (int i = 0; i < config.getNumViews(on.c_str()); ++i)
            views.emplace_back(config.getView(on.c_str(), i));
        expect_name(impl_->name, through, "view of " + on, views);
        ColourTransform transform;
        const auto processor = config.getProcessor((from.empty() ? scene_linear() : from).c_str(), on.c_str(),
                                                   through.c_str(), ocio::TRANSFORM_DIR_FORWARD);
        transform.processor_ = std::make_shared<const ColourTransform::Processor>(
            ColourTransform::Processor{exactly(*processor)});
        return transform;
    });
}

void transform_colours(const ColourTransform &transform, std::span<const Channel> channels,
                       std::span<const std::span<float>> planes) {
    if (transform.changes_nothing()) return;
    const std::size_t alpha = find_channel(channels, "A");
    for (std::size_t r = 0; r < channels.size(); ++r) {
        const std::string &name = channels[r].name;
        if (name != "R" && !name.ends_with(".R")) continue;
        const std::string layer = name.substr(0, name.size() - 1);
        const std::size_t g = find_channel(channels, layer + "G"), b = find_channel(channels, layer + "B");
        if (g == npos || b == npos) continue;
        const std::array all{r, g, b};
        if (std::ranges::any_of(all, [&](std::size_t k) { return !is_light(channels[k]); })) continue;
        transform.apply(planes[r], planes[g], planes[b], alpha == npos ? nullptr : planes[alpha].data());
    }
}

void transform_colours(const ColourTransform &transform, Image &image) {
    transform_colours(transform, image.channels, planes_of(image));
}

namespace {

constexpr const char *interop_id = "colorInteropID", *oiio_space = "oiio:ColorSpace";

std::string space_in(const Imf::Header &header, const char *name) {
    const std::string text = text_attribute(header, name);
    return text == "unknown" || text == "data" ? "" : text;
}

} // namespace

bool states_space(const Imf::Header &header) {
    return Imf::hasChromaticities(header) || !space_in(header, interop_id).empty() ||
           !space_in(header, oiio_space).empty();
}

std::optional<StatedSpace> stated_space(const ColourConfig &config, const Imf::Header &header) {
    if (Imf::hasChromaticities(header))
        return StatedSpace{"chromaticities", config.linear_space(Imf::chromaticities(header))};
    if (const std::string id = space_in(header, interop_id); !id.empty())
        return StatedSpace{interop_id, config.space_named(id)};
    if (const auto space = config.space_named(space_in(header, oiio_space)))
        return StatedSpace{oiio_space, space};
    return {};
}

Imf::Header with_space(const ColourConfig &config, const Imf::Header &header, const std::string &space) {
    Imf::Header result = header;
    if (const auto chromaticities = config.chromaticities_of(space))
        set_attribute(result, "chromaticities", Imf::ChromaticitiesAttribute(*chromaticities));
    else
        result = without_attribute(header, "chromaticities");
    for (const char *name : {interop_id, oiio_space}) {
        const bool is_there = header.find(name) != header.end();
        if (!is_there || config.space_named(space_in(header, name)) == config.space_named(space)) continue;
        const std::string id = name == interop_id ? config.interop_id(space) : "";
        if (id.empty())
            result = without_attribute(result, name);
        else
            set_attribute(result, name, Imf::StringAttribute(id));
    }
    return result;
}

Imf::Header with_space_of(const Imf::Header &other, const Imf::Header &header) {
    Imf::Header result = header;
    for (const char *name : {"chromaticities", interop_id, oiio_space}) {
        const auto said = other.find(name);
        if (said != other.end())
            set_attribute(result, name, said.attribute());
        else if (header.find(name) != header.end())
            result = without_attribute(result, name);
    }
    return result;
}

} // namespace sparselens
