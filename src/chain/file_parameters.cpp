#include "base/text.h"
#include "chain/parameter_rows.h"

#include <array>

namespace sparselens {

using namespace parameter_rows;

ParameterRows<LensValues> lens_parameters() {
    static const auto rows = [] {
        constexpr std::array on_pages{"fstop", "lens-radius", "focus-distance"};
        Rows<LensValues> all_numbers;
        for (const auto &of : lens_numbers()) {
            all_numbers.push_back({keyed(number(of)), in(of.value)});
            all_numbers.back().page = is_among(on_pages, of.name);
        }
        return all(std::move(all_numbers), "Lens");
    }();
    return rows;
}

ParameterRows<DepthOptions> depth_parameters() {
    static const auto rows = all<DepthOptions>(
        {{word("depth", {"z", "distance", "inverse", "negative", "normalized", "hyperbolic"},
               "Kind of depth. z: planar; distance: from the camera along the ray; inverse: 1 / z; negative: "
               "-z; normalized: 0 at `near` to 1 at `far` (if near is white, `near` is the larger); "
               "hyperbolic: the same, but linear in 1 / z, as in a depth buffer (default: z)"),
          in(&DepthOptions::meaning)},
         {number("near", "D",
                 "With `depth=normalized` and hyperbolic, the depth of 0 (default: the near attribute of the "
                 "file)",
                 above_0_or_inf),
          in(&DepthOptions::near)},
         {number("far", "D",
                 "Depths beyond this are sky; with `depth=normalized` and hyperbolic, the depth of 1 "
                 "(default: 1e10)",
                 above_0_or_inf),
          in(&DepthOptions::far)},
         {text("depth-channel", "NAME",
               "Depth channel of the picture, or of `depth_file` (default: Z, depth.Z, *.Depth.Z or the "
               "like)"),
          in(&DepthOptions::picture, &PictureChoice::depth)}},
        "Lens", "", PythonCall::open_ldi);
    return rows;
}

ParameterRows<PictureChoice> choice_parameters() {
    static const auto rows = all<PictureChoice>(
        {{in_group("Colour",
                   flag("unpremultiplied",
                        "Multiply the colours of the input by its coverage (A); the default expects "
                        "multiplied colours")),
          in(&PictureChoice::unpremultiplied)},
         {text("stereo-view", "NAME", "Stereo view to read, e.g. right (default: the file's first)"),
          in(&PictureChoice::stereo_view)},
         {text("layer", "NAME",
               "Picture to read if a file holds several, such as view layers of Blender, with its depth and "
               "passes (default: the only one)"),
          in(&PictureChoice::layer)}},
        "Lens", "", PythonCall::open_ldi);
    return rows;
}

ParameterRows<PictureChoice> depth_file_parameters() {
    static const auto rows = all<PictureChoice>(
        {{text("depth-file", "FILE.exr", "File with the depth of the picture (EXR, flat, of the same size)",
               Form::file),
          in(&PictureChoice::depth_file)}},
        "Lens", "", PythonCall::open_ldi);
    return rows;
}

ParameterRows<ColourOptions> input_colour_parameters() {
    static const auto rows = all<ColourOptions>(
        {{text("colorconfig", "FILE", "OpenColorIO configuration (default: $OCIO, else the built-in one)",
               Form::file),
          in(&ColourOptions::config)},
         {of_tools(text("colorspace", "SPACE",
                        "Colour space of the input (default: by its chromaticities or colorInteropID, else "
                        "the file rules of the configuration)")),
          in(&ColourOptions::input_space)}},
        "Colour", "", PythonCall::write);
    return rows;
}

ParameterRows<ColourOptions> output_colour_parameters() {
    static const auto rows = all<ColourOptions>(
        {{of_tools(text("output-colorspace", "SPACE",
                        "Colour space of the output (default: that of the input for EXR, else that of the "
                        "display)")),
          in(&ColourOptions::output_space)},
         {text("display", "DISPLAY", "Display for PNG, JPEG and TIFF (default: that of the configuration)"),
          in(&ColourOptions::display)},
         {text("view-transform", "VIEW", "View transform of the display (default: that of the display)"),
          in(&ColourOptions::view)}},
        "Colour", "", PythonCall::write);
    return rows;
}

} // namespace sparselens
