#include "describe.h"

#include "host.h"
#include "parameter_table.h"

#include <algorithm>
#include <limits>
#include <set>
#include <string>

namespace sparselens_ofx {

namespace {

constexpr double largest = std::numeric_limits<double>::max();
constexpr int largest_whole = 1 << 24;

// Defines a parameter and returns its properties.
OfxPropertySetHandle defined(OfxParamSetHandle all, const char *type, const std::string &name,
                             const std::string &label, const std::string &hint) {
    OfxPropertySetHandle properties = nullptr;
    if (suites().parameters->paramDefine(all, type, name.c_str(), &properties) != kOfxStatOK)
        throw HostError("the host does not take the parameter " + name);
    set(properties, kOfxPropLabel, label);
    set(properties, kOfxParamPropScriptName, name);
    if (!hint.empty()) set(properties, kOfxParamPropHint, hint);
    return properties;
}

OfxPropertySetHandle define_number(OfxParamSetHandle all, const ParameterRow &row, const std::string &name,
                                   const std::string &label) {
    const OfxPropertySetHandle number = defined(all, kOfxParamTypeDouble, name, label, row.hint);
    set(number, kOfxParamPropDefault, row.nothing);
    set(number, kOfxParamPropMin, -largest);
    set(number, kOfxParamPropMax, largest);
    set(number, kOfxParamPropDisplayMin, row.low);
    set(number, kOfxParamPropDisplayMax, row.high);
    return number;
}

OfxPropertySetHandle define_whole(OfxParamSetHandle all, const ParameterRow &row) {
    const OfxPropertySetHandle whole = defined(all, kOfxParamTypeInteger, row.name, row.label, row.hint);
    set(whole, kOfxParamPropDefault, int(row.nothing));
    set(whole, kOfxParamPropMin, int(row.low));
    set(whole, kOfxParamPropMax, largest_whole);
    set(whole, kOfxParamPropDisplayMin, int(row.low));
    set(whole, kOfxParamPropDisplayMax, int(row.high));
    return whole;
}

OfxPropertySetHandle define_choice(OfxParamSetHandle all, const ParameterRow &row) {
    const OfxPropertySetHandle choice = defined(all, kOfxParamTypeChoice, row.name, row.label, row.hint);
    int count = 0;
    set(choice, kOfxParamPropChoiceOption, "default", count++);
    for (const std::string &word : words_of(row)) set(choice, kOfxParamPropChoiceOption, word, count++);
    set(choice, kOfxParamPropDefault, 0);
    return choice;
}

OfxPropertySetHandle define_text(OfxParamSetHandle all, const std::string &name, const std::string &label,
                                 const std::string &hint, bool is_file) {
    const OfxPropertySetHandle text = defined(all, kOfxParamTypeString, name, label, hint);
    set(text, kOfxParamPropDefault, "");
    set(text, kOfxParamPropStringMode, is_file ? kOfxParamStringIsFilePath : kOfxParamStringIsSingleLine);
    if (is_file) set(text, kOfxParamPropStringFilePathExists, 0); // a sequence has a pattern
    set(text, kOfxParamPropAnimates, 0);
    return text;
}

std::string name_of_group(const std::string &label) {
    std::string name = "group_" + label;
    std::ranges::replace(name, ' ', '_');
    return name;
}

void finish(OfxPropertySetHandle parameter, const ParameterRow &row) {
    const bool is_text =
        row.kind == ParameterKind::text || row.kind == ParameterKind::file; // few hosts key those
    set(parameter, kOfxParamPropAnimates, row.keyable && !is_text ? 1 : 0);
    if (*row.group) set(parameter, kOfxParamPropParent, name_of_group(row.group));
}

void define(OfxParamSetHandle all, const ParameterRow &row) {
    switch (row.kind) {
    case ParameterKind::flag: {
        const OfxPropertySetHandle flag = defined(all, kOfxParamTypeBoolean, row.name, row.label, row.hint);
        set(flag, kOfxParamPropDefault, 0);
        return finish(flag, row);
    }
    case ParameterKind::whole: return finish(define_whole(all, row), row);
    case ParameterKind::number: return finish(define_number(all, row, row.name, row.label), row);
    case ParameterKind::pair:
        finish(define_number(all, row, name_x(row), row.label + std::string(", x")), row);
        return finish(define_number(all, row, name_y(row), row.label + std::string(", y")), row);
    case ParameterKind::choice: return finish(define_choice(all, row), row);
    case ParameterKind::text:
    case ParameterKind::file:
        return finish(define_text(all, row.name, row.label, row.hint, row.kind == ParameterKind::file), row);
    }
}

void define_own_parameters(OfxParamSetHandle all, bool has_source) {
    define_text(
        all, ldi_parameter, "LDI",
        std::string(
            "A layered depth image, any deep EXR, a flat EXR with depth, or a .dof file. #### or %04d "
            "stands for the number of the frame") +
            (has_source ? ". If empty, the source is refocused by its depth" : ""),
        true);
    const OfxPropertySetHandle offset =
        defined(all, kOfxParamTypeInteger, offset_parameter, "Frame offset",
                "Added to the frame of the host, for the number in the name of the LDI");
    set(offset, kOfxParamPropDefault, 0);
    set(offset, kOfxParamPropMin, -largest_whole);
    set(offset, kOfxParamPropMax, largest_whole);
    set(offset, kOfxParamPropDisplayMin, -100);
    set(offset, kOfxParamPropDisplayMax, 100);
    set(offset, kOfxParamPropAnimates, 0);
}

// Parameters without a group come first, then the groups in the order of the table.
void define_parameters(OfxParamSetHandle all) {
    for (const ParameterRow &row : parameter_table())
        if (!*row.group) define(all, row);
    std::set<std::string> groups;
    for (const ParameterRow &first : parameter_table()) {
        if (!*first.group || !groups.insert(first.group).second) continue;
        set(defined(all, kOfxParamTypeGroup, name_of_group(first.group), first.group, ""),
            kOfxParamPropGroupOpen, 0);
        for (const ParameterRow &row : parameter_table())
            if (row.group == std::string(first.group)) define(all, row);
    }
}

void define_clip(OfxImageEffectHandle effect, const char *name, bool optional, bool alpha_too) {
    OfxPropertySetHandle clip = nullptr;
    if (suites().effects->clipDefine(effect, name, &clip) != kOfxStatOK)
        throw HostError(std::string("the host does not take the clip ") + name);
    set(clip, kOfxImageEffectPropSupportedComponents, kOfxImageComponentRGBA, 0);
    set(clip, kOfxImageEffectPropSupportedComponents, kOfxImageComponentRGB, 1);
    if (alpha_too) set(clip, kOfxImageEffectPropSupportedComponents, kOfxImageComponentAlpha, 2);
    set(clip, kOfxImageEffectPropTemporalClipAccess, 0);
    set(clip, kOfxImageEffectPropSupportsTiles, 1);
    if (optional) set(clip, kOfxImageClipPropOptional, 1);
}

} // namespace

void describe(OfxImageEffectHandle effect) {
    const OfxPropertySetHandle properties = properties_of(effect);
    set(properties, kOfxPropLabel, "sparselens");
    set(properties, kOfxPropShortLabel, "sparselens");
    set(properties, kOfxPropLongLabel, "sparselens depth of field");
    set(properties, kOfxPropPluginDescription,
        "Refocuses a layered depth image, or a flat picture with its depth. dof-view, of the same "
        "installation, makes the pictures.");
    set(properties, kOfxImageEffectPluginPropGrouping, "sparselens");
    int count = 0;
    for (const char *context :
         {kOfxImageEffectContextFilter, kOfxImageEffectContextGeneral, kOfxImageEffectContextGenerator})
        set(properties, kOfxImageEffectPropSupportedContexts, context, count++);
    count = 0;
    for (const char *depth : {kOfxBitDepthByte, kOfxBitDepthShort, kOfxBitDepthHalf, kOfxBitDepthFloat})
        set(properties, kOfxImageEffectPropSupportedPixelDepths, depth, count++);
    set(properties, kOfxImageEffectPluginRenderThreadSafety, kOfxImageEffectRenderFullySafe);
    set(properties, kOfxImageEffectPluginPropHostFrameThreading, 0);
    set(properties, kOfxImageEffectPluginPropSingleInstance, 0);
    set(properties, kOfxImageEffectPropSupportsMultiResolution, 1);
    set(properties, kOfxImageEffectPropSupportsTiles, 1);
    set(properties, kOfxImageEffectPropTemporalClipAccess, 0);
    set(properties, kOfxImageEffectPropSupportsMultipleClipDepths,
        1); // depth is not cut to the source's 8 bits
    set(properties, kOfxImageEffectPropSupportsMultipleClipPARs, 0);
}

void describe_in_context(OfxImageEffectHandle effect, OfxPropertySetHandle arguments) {
    const std::string context = text_in(arguments, kOfxImageEffectPropContext, kOfxImageEffectContextFilter);
    const bool generator = context == kOfxImageEffectContextGenerator;
    if (!generator) {
        define_clip(effect, source_clip, context != kOfxImageEffectContextFilter, false);
        define_clip(effect, depth_clip, true, true);
    }
    define_clip(effect, output_clip, false, false);
    const OfxParamSetHandle all = parameters_of(effect);
    define_own_parameters(all, !generator);
    define_parameters(all);
}

} // namespace sparselens_ofx
