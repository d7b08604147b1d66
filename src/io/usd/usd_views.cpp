#include "io/usd/usd_views.h"

#include "base/error.h"
#include "lens/thin_lens.h"
#include "plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace sparselens {

namespace {

// Files hold matrices as floats, whose axes are not quite perpendicular.
Imath::M44d rigid(Imath::M44d m) {
    const auto axis = [&](int row) { return Imath::V3d(m[row][0], m[row][1], m[row][2]); };
    const Imath::V3d back = axis(2).normalized();
    const Imath::V3d up = (axis(1) - axis(1).dot(back) * back).normalized();
    const Imath::V3d right = up.cross(back);
    const Imath::V3d axes[] = {right, up, back};
    for (int row = 0; row < 3; ++row)
        for (int k = 0; k < 3; ++k) m[row][k] = axes[row][k];
    return m;
}

std::string text_of(double value) { return fmt::format("{}", value + 0.0); } // no -0
std::string text_of(const Imath::V2d &v) { return fmt::format("({}, {})", text_of(v.x), text_of(v.y)); }
std::string text_of(const Imath::V3d &v) {
    return fmt::format("({}, {}, {})", text_of(v.x), text_of(v.y), text_of(v.z));
}
std::string text_of(const Imath::M44d &m) {
    std::string rows;
    for (int row = 0; row < 4; ++row)
        rows += fmt::format("{}({}, {}, {}, {})", row > 0 ? ", " : "", text_of(m[row][0]), text_of(m[row][1]),
                            text_of(m[row][2]), text_of(m[row][3]));
    return "( " + rows + " )";
}

class Writer {
public:
    explicit Writer(const UsdViews &views) : views_(views) {}

    std::string text() {
        write_head();
        write_cameras();
        write_settings();
        return std::move(text_);
    }

private:
    template <typename... Values>
    void line(fmt::format_string<Values...> format, Values &&...values) {
        text_.append(std::size_t(levels_) * 4, ' ');
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
        text_ += '\n';
    }
    void open() { line("{{"), ++levels_; }
    void close() { --levels_, line("}}"); }

    // One value if it never changes; otherwise one for each time.
    template <typename Value>
    void keyed(const char *name, const Value &value_of) {
        std::vector<std::string> values;
        for (const auto &[time, frame] : views_.frames) values.push_back(text_of(value_of(frame)));
        if (std::ranges::adjacent_find(values, std::not_equal_to<>()) == values.end())
            return line("{} = {}", name, values[0]);
        line("{}.timeSamples = {{", name);
        auto value = values.begin();
        for (const auto &[time, frame] : views_.frames) line("    {}: {},", time, *value++);
        line("}}");
    }

    void write_head();
    void write_cameras();
    void write_camera(const std::string &name, const Imath::V2d *lens_point);
    void write_settings();
    void write_product(const std::string &name);
    void write_variable(const char *name, const char *type, const char *source);

    const UsdViews &views_;
    std::string text_;
    int levels_ = 0;
};

std::string view_name(std::size_t k) { return fmt::format("view_{}", k); }

void Writer::write_head() {
    line("#usda 1.0");
    line("(");
    line("    defaultPrim = \"sparselens\"");
    std::string source = views_.source; // a name of a file, which may hold anything
    std::erase_if(source,
                  [](char c) { return c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' '; });
    line("    doc = \"The views of {}, written by ldi-plan of sparselens.\"", source);
    if (views_.keyed) {
        line("    startTimeCode = {}", views_.frames.begin()->first);
        line("    endTimeCode = {}", views_.frames.rbegin()->first);
        line("    timeCodesPerSecond = {}", views_.frames_per_second);
        line("    framesPerSecond = {}", views_.frames_per_second);
    }
    line("    metersPerUnit = {}", views_.metres_per_unit);
    line("    renderSettingsPrimPath = \"/Render/sparselens\"");
    line("    upAxis = \"{}\"", views_.up_axis);
    line(")");
}

void Writer::write_cameras() {
    text_ += '\n';
    line("def Xform \"sparselens\"");
    open();
    line("def Xform \"lens\"");
    open();
    keyed("matrix4d xformOp:transform", [](const UsdLensFrame &f) { return f.to_world; });
    line("uniform token[] xformOpOrder = [\"xformOp:transform\"]");
    write_camera("center", nullptr);
    for (std::size_t k = 0; k < views_.lens_points.size(); ++k)
        write_camera(view_name(k), &views_.lens_points[k]);
    close();
    close();
}

void Writer::write_camera(const std::string &name, const Imath::V2d *lens_point) {
    // USD counts apertures and focal lengths in tenths of a scene unit.
    const auto tenths = [&](double mm) { return mm / (100 * views_.metres_per_unit); };
    const double shape = double(views_.windows.display_height()) /
                         (double(views_.windows.display_width()) * double(views_.windows.pixel_aspect));
    text_ += '\n';
    line("def Camera \"{}\"", name);
    open();
    keyed("float2 clippingRange", [](const UsdLensFrame &f) { return f.clipping; });
    keyed("float focalLength", [&](const UsdLensFrame &f) { return tenths(f.focal_length_mm); });
    keyed("float focusDistance",
          [](const UsdLensFrame &f) { return std::isfinite(f.focus_distance) ? f.focus_distance : 0; });
    line("float fStop = 0");
    keyed("float horizontalAperture", [&](const UsdLensFrame &f) { return tenths(f.film_width_mm); });
    keyed("float horizontalApertureOffset", [&](const UsdLensFrame &f) { return tenths(f.offset_mm.x); });
    line("token projection = \"perspective\"");
    keyed("float verticalAperture", [&](const UsdLensFrame &f) { return tenths(f.film_width_mm * shape); });
    keyed("float verticalApertureOffset", [&](const UsdLensFrame &f) { return tenths(f.offset_mm.y); });
    keyed("custom double sparselens:focusDistance", [](const UsdLensFrame &f) { return f.focus_distance; });
    keyed("custom double sparselens:fStop", [](const UsdLensFrame &f) { return f.fstop; });
    if (lens_point) {
        keyed("double3 xformOp:translate", [&](const UsdLensFrame &f) {
            return Imath::V3d(lens_point->x * f.radius, lens_point->y * f.radius, 0);
        });
        line("uniform token[] xformOpOrder = [\"xformOp:translate\"]");
    }
    close();
}

void Writer::write_settings() {
    const Windows &windows = views_.windows;
    std::string products = "</Render/sparselens/center>";
    for (std::size_t k = 0; k < views_.lens_points.size(); ++k)
        products += fmt::format(", </Render/sparselens/{}>", view_name(k));
    text_ += '\n';
    line("def Scope \"Render\"");
    open();
    line("def RenderSettings \"sparselens\"");
    open();
    line("rel camera = </sparselens/lens/center>");
    line("uniform bool disableDepthOfField = 1");
    line("uniform float pixelAspectRatio = {}", windows.pixel_aspect);
    line("rel products = [{}]", products);
    line("uniform int2 resolution = ({}, {})", windows.display_width(), windows.display_height());
    if (windows.data != windows.display) { // y up in USD
        const double w = windows.display_width(), h = windows.display_height();
        const Imath::V2i from = windows.data.min - windows.display.min,
                         to = windows.data.max - windows.display.min;
        line("uniform float4 dataWindowNDC = ({}, {}, {}, {})", from.x / w, 1 - (to.y + 1) / h,
             (to.x + 1) / w, 1 - from.y / h);
    }
    write_product("center");
    for (std::size_t k = 0; k < views_.lens_points.size(); ++k) write_product(view_name(k));
    write_variable("rgba", "color4f", "color");
    write_variable("depth", "float", "cameraDepth");
    close();
    close();
}

void Writer::write_product(const std::string &name) {
    text_ += '\n';
    line("def RenderProduct \"{}\"", name);
    open();
    line("rel camera = </sparselens/lens/{}>", name);
    line("rel orderedVars = [</Render/sparselens/rgba>, </Render/sparselens/depth>]");
    if (views_.keyed) {
        line("token productName.timeSamples = {{");
        for (const auto &[time, frame] : views_.frames)
            if (time == std::floor(time)) line("    {}: \"{}.{:04}.exr\",", time, name, long(time));
        line("}}");
    } else {
        line("token productName = \"{}.exr\"", name);
    }
    close();
}

void Writer::write_variable(const char *name, const char *type, const char *source) {
    text_ += '\n';
    line("def RenderVar \"{}\"", name);
    open();
    line("uniform token dataType = \"{}\"", type);
    line("uniform string sourceName = \"{}\"", source);
    close();
}

} // namespace

UsdLensFrame usd_lens_frame(const Camera &camera, const ThinLens &lens, int display_width,
                            const std::string &file) {
    if (!camera.world_to_camera)
        throw Error(file + ": does not say where its camera stands (worldToCamera): give its `camera`");
    constexpr double any_film = 36; // mm, where only the field of view is known
    const double mm = 1 / (1000 * camera.metres_per_unit.value_or(1)); // in scene units
    const double focal_length = camera.focal_length_mm.value_or(any_film * lens.focal_px / display_width);
    const double width = camera.sensor_width_mm.value_or(focal_length * display_width / lens.focal_px);
    const Imath::V2d axis = camera.principal_point.value_or(Imath::V2d(0, 0));
    UsdLensFrame frame;
    // Camera space (x right, y up, z forward) is left-handed, so a right-handed world is mirrored on the way to it.
    frame.mirrored = camera.world_to_camera->determinant() > 0;
    const Imath::M44d mirror = Imath::M44d().setScale(Imath::V3d(1, 1, frame.mirrored ? -1 : 1));
    frame.to_world = rigid(camera_to_world_looking_back(mirror * *camera.world_to_camera));
    frame.focal_length_mm = focal_length;
    frame.film_width_mm = width;
    frame.offset_mm = Imath::V2d(0 - axis.x, axis.y) * width;
    frame.radius = lens.radius;
    frame.fstop =
        camera.fstop.value_or(fstop_of(lens.radius, focal_length, camera.metres_per_unit.value_or(1)));
    frame.focus_distance = lens.focus;
    frame.clipping = {10 * mm, 1e7 * mm};
    return frame;
}

void add_lens_points(UsdViews &views, const std::vector<Imath::V2d> &points) {
    const auto tidy = [](double x) {
        return std::round(x * 1e15) / 1e15 + 0.0;
    }; // no 6e-17 in the file, and no -0
    for (const Imath::V2d &exact : points) {
        const Imath::V2d point(tidy(exact.x), tidy(exact.y));
        if (std::ranges::none_of(views.lens_points,
                                 [&](const Imath::V2d &p) { return (p - point).length() < 1e-9; }))
            views.lens_points.push_back(point);
    }
}

std::string usd_text(const UsdViews &views) { return Writer(views).text(); }

} // namespace sparselens
