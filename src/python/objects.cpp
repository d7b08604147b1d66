#include "python/objects.h"

#include "base/text.h"
#include "chain/notices.h"
#include "io/camera/camera_header.h"
#include "python/arrays.h"
#include "python/verbs.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <sparselens_docs.h>

#include <array>
#include <cmath>

namespace sparselens::python {

namespace {

using Matrix = std::array<std::array<double, 4>, 4>;

py::tuple box_of(const Imath::Box2i &box) {
    return py::make_tuple(box.min.x, box.min.y, box.max.x, box.max.y);
}

py::tuple names_of(const std::vector<Channel> &channels) {
    py::list names;
    for (const Channel &channel : channels) names.append(channel.name);
    return names;
}

std::string text_of(const char *type, const std::string &name, const Windows &windows,
                    const std::string &more) {
    return fmt::format("<sparselens.{}{} {}x{}, {}>", type, name.empty() ? "" : " " + name, windows.width(),
                       windows.height(), more);
}

// An array of one value per sample, or None if the LDI has no such values.
py::object optional_samples(const std::vector<float> &values, const py::object &owner) {
    return values.empty() ? py::object(py::none()) : py::object(shared(values, owner));
}

py::array samples_of(const py::object &self, const std::string &channel) {
    const Ldi &ldi = self.cast<const LdiObject &>().ldi;
    const std::size_t k = channel_named(ldi.channels, channel);
    return shared(ldi.values[k], self, {}, Access::read_only, ldi.channels[k].type);
}

// Adds an attribute that cannot be set.
template <typename Object, typename Get>
void property(py::class_<Object> &type, const char *name, const char *text, const Get &get) {
    type.def_property_readonly(name, get, text);
}

// Binds the windows of an object.
template <typename Object, typename Get>
void bind_windows(py::class_<Object> &type, const Get &windows_of) {
    namespace Doc = doc::Windows;
    property(type, "width", Doc::width, [=](const Object &o) { return windows_of(o).width(); });
    property(type, "height", Doc::height, [=](const Object &o) { return windows_of(o).height(); });
    property(type, "data_window", Doc::data_window,
             [=](const Object &o) { return box_of(windows_of(o).data); });
    property(type, "display_window", Doc::display_window,
             [=](const Object &o) { return box_of(windows_of(o).display); });
    property(type, "pixel_aspect", Doc::pixel_aspect,
             [=](const Object &o) { return windows_of(o).pixel_aspect; });
}

// Binds the channels of an object's image.
template <typename Object, typename Get>
void bind_image(py::class_<Object> &type, const Get &image_of, Access access) {
    bind_windows(type, [=](const Object &o) -> const Windows & { return image_of(o).windows; });
    const auto planes = [=](const py::object &self) {
        return planes_of(image_of(self.cast<const Object &>()), self, access);
    };
    property(type, "channels", doc::Windows::channels,
             [=](const Object &o) { return names_of(image_of(o).channels); });
    property(type, "planes", doc::Image::planes, planes);
    property(type, "pixels", doc::Image::pixels,
             [=](const py::object &self) { return planes(self).attr("transpose")(1, 2, 0); });
    type.def(
        "__getitem__",
        [=](const py::object &self, const std::string &channel) {
            return plane_of(image_of(self.cast<const Object &>()), channel, self, access);
        },
        py::arg("channel"), doc::Image::getitem);
}

py::tuple pair_of(const Imath::V2d &v) { return py::make_tuple(v.x, v.y); }

void bind_camera(py::module_ &module) {
    py::class_<Camera> type(module, "Camera", doc::Camera::text);
    type.def_readonly("focal_length", &Camera::focal_length_mm, doc::Camera::focal_length)
        .def_readonly("sensor_width", &Camera::sensor_width_mm, doc::Camera::sensor_width)
        .def_readonly("fstop", &Camera::fstop, doc::Camera::fstop)
        .def_property_readonly("lens_radius", &lens_radius_of, doc::Camera::lens_radius)
        .def_readonly("supersample", &Camera::supersample, doc::Camera::supersample)
        .def_readonly("focus_distance", &Camera::focus_distance, doc::Camera::focus_distance)
        .def_readonly("scene_unit", &Camera::metres_per_unit, doc::Camera::scene_unit);
    property(type, "world_to_camera", doc::Camera::world_to_camera,
             [](const Camera &camera) -> std::optional<Matrix> {
                 if (!camera.world_to_camera) return {};
                 Matrix m;
                 for (int i = 0; i < 4; ++i)
                     for (int k = 0; k < 4; ++k)
                         m[std::size_t(i)][std::size_t(k)] = (*camera.world_to_camera)[i][k];
                 return m;
             });
    property(type, "lens_points", doc::Camera::lens_points, [](const Camera &camera) {
        py::list points;
        for (const Imath::V2d &p : camera.lens_points) points.append(pair_of(p));
        return points;
    });
    type.def("__repr__", [](const py::object &camera) {
        std::string text = "<sparselens.Camera";
        for (const char *name : {"focal_length", "sensor_width", "fstop", "focus_distance", "scene_unit"})
            if (const py::object value = camera.attr(name); !value.is_none())
                text += fmt::format(" {}={}", name, std::string(py::repr(value)));
        return text + ">";
    });
}

void bind_view(py::module_ &module) {
    py::class_<ViewObject> type(module, "View", doc::View::text);
    type.def(py::init(&view_from), py::arg("image"), py::arg("z") = py::none(), doc::View::init);
    bind_image(
        type, [](const ViewObject &view) -> const Image & { return view.in.view.image; }, Access::read_only);
    property(type, "z", doc::View::z, [](const py::object &self) {
        const View &view = self.cast<const ViewObject &>().in.view;
        const Windows &w = view.image.windows;
        return shared(view.z, self, {std::size_t(w.height()), std::size_t(w.width())});
    });
    property(type, "name", doc::Opened::name, [](const ViewObject &view) { return view.in.view.name; });
    property(type, "position", doc::View::position, [](const ViewObject &view) {
        return view.position ? py::object(pair_of(*view.position)) : py::object(py::none());
    });
    property(type, "camera", doc::Opened::camera, [](const ViewObject &view) { return view.in.camera; });
    property(type, "notes", doc::Opened::notes, [](const ViewObject &view) { return view.in.notes; });
    type.def("__repr__", [](const ViewObject &view) {
        const Image &image = view.in.view.image;
        return text_of("View", view.in.view.name, image.windows,
                       fmt::format("{} channels and z", image.channels.size()));
    });
}

void bind_ldi(py::module_ &module) {
    py::class_<LdiObject> type(module, "Ldi", doc::Ldi::text);
    type.def(py::init(&ldi_from), py::arg("begin"), py::arg("z"), py::arg("channels"), doc::Ldi::init);
    bind_windows(type, [](const LdiObject &in) -> const Windows & { return in.ldi.windows; });
    const auto samples = [&](const char *name, std::vector<float> Ldi::*member, const char *text) {
        property(type, name, text, [member](const py::object &self) {
            return optional_samples(self.cast<const LdiObject &>().ldi.*member, self);
        });
    };
    property(type, "begin", doc::Ldi::begin,
             [](const py::object &self) { return shared(self.cast<const LdiObject &>().ldi.begin, self); });
    property(type, "z", doc::Ldi::z,
             [](const py::object &self) { return shared(self.cast<const LdiObject &>().ldi.z, self); });
    samples("z_back", &Ldi::z_back, doc::Ldi::z_back);
    samples("dx", &Ldi::dx, doc::Ldi::dx);
    samples("dy", &Ldi::dy, doc::Ldi::dy);
    samples("weight", &Ldi::weight, doc::Ldi::weight);
    samples("optical", &Ldi::image_z, doc::Ldi::optical);
    samples("solid", &Ldi::solid, doc::Ldi::solid);
    property(type, "channels", doc::Windows::channels,
             [](const LdiObject &in) { return names_of(in.ldi.channels); });
    property(type, "samples", doc::Ldi::samples, [](const LdiObject &in) { return in.ldi.samples(); });
    type.def("__getitem__", &samples_of, py::arg("channel"), doc::Ldi::getitem)
        .def_readonly("name", &LdiObject::name, doc::Opened::name)
        .def_readonly("camera", &LdiObject::camera, doc::Opened::camera)
        .def_readonly("notes", &LdiObject::notes, doc::Opened::notes)
        .def("__repr__", [](const LdiObject &in) {
            return text_of("Ldi", in.name, in.ldi.windows, fmt::format("{} samples", in.ldi.samples()));
        });
}

void bind_picture(py::module_ &module) {
    py::class_<PictureObject> type(module, "Picture", doc::Picture::text);
    type.def(py::init(&picture_from), py::arg("image"), doc::Picture::init);
    bind_image(
        type, [](const PictureObject &picture) -> const Image & { return picture.image; }, Access::writable);
    property(type, "camera", doc::Picture::camera,
             [](const PictureObject &picture) { return read_camera(picture.header); });
    type.def("_repr_png_", &png_of, doc::Picture::repr_png).def("__repr__", [](const PictureObject &picture) {
        return text_of("Picture", {}, picture.image.windows,
                       fmt::format("{} channels", picture.image.channels.size()));
    });
}

void bind_planned_view(py::module_ &module) {
    namespace Doc = doc::PlannedView;
    using Planned = PlannedViewObject;
    py::class_<Planned> type(module, "PlannedView", Doc::text);
    property(type, "lens_point", Doc::lens_point, [](const Planned &o) { return pair_of(o.view.u); });
    property(type, "position", Doc::position,
             [](const Planned &o) { return pair_of(o.lens.radius * o.view.u); });
    property(type, "share", Doc::share,
             [](const Planned &o) { return double(o.view.mask.count()) / double(o.view.mask.set.size()); });
    property(type, "uncovered", Doc::uncovered, [](const Planned &o) { return o.view.uncovered; });
    property(type, "mask", Doc::mask, [](const py::object &self) {
        const PixelMask &mask = self.cast<const Planned &>().view.mask;
        return shared(mask.set, self, std::size_t(mask.width()));
    });
    property(type, "rectangles", Doc::rectangles, [](const Planned &o) {
        py::list boxes;
        for (const Imath::Box2i &box : rectangles_over(o.view.mask)) boxes.append(box_of(box));
        return boxes;
    });
}

void bind_plan(py::module_ &module) {
    namespace Doc = doc::Plan;
    bind_planned_view(module);
    py::class_<PlanObject> type(module, "Plan", Doc::text);
    property(type, "views", Doc::views, [](const PlanObject &o) {
        std::vector<PlannedViewObject> views;
        for (const PlannedView &view : o.plan.views) views.push_back({view, o.setting.lens});
        return views;
    });
    property(type, "share", Doc::share, [](const PlanObject &o) { return o.plan.share(); });
    property(type, "full_views", Doc::full_views, [](const PlanObject &o) { return o.plan.full_views; });
    property(type, "supersample", Doc::supersample, [](const PlanObject &o) { return o.plan.supersample; });
    property(type, "rays", Doc::rays, [](const PlanObject &o) -> py::object {
        const auto &rays = o.setting.division;
        if (!rays) return py::none();
        return py::dict(py::arg("views") = rays->views, py::arg("supersample") = rays->supersample,
                        py::arg("samples") = rays->samples, py::arg("per_render") = rays->per_render,
                        py::arg("noise_db") = -10 * std::log10(rays->noise), py::arg("alone") = rays->alone);
    });
    property(type, "moments", Doc::moments, [](const PlanObject &o) {
        return o.setting.moments ? std::optional(o.setting.moments->moments) : std::nullopt;
    });
    property(type, "motion", Doc::motion, [](const PlanObject &o) {
        return o.setting.moments ? std::optional(o.setting.moments->motion) : std::nullopt;
    });
    property(type, "noise_db", Doc::noise_db,
             [](const PlanObject &o) { return -10 * std::log10(o.plan.noise); });
    property(type, "overscan", Doc::overscan, [](const PlanObject &o) {
        const OverscanNeed &need = o.plan.overscan;
        return py::make_tuple(need.left, need.top, need.right, need.bottom);
    });
}

} // namespace

std::string with_keywords(const std::string &message) {
    return spelled(message, [](const std::string &name, const std::string &value) {
        if (name == "view") // its value may be followed by the name of a file
            return value.empty() ? "position" : "position=(" + value.substr(0, value.find(' ')) + ")";
        const bool is_number = value.find_first_not_of("0123456789.") == value.npos;
        return name + (value.empty() ? "" : is_number ? "=" + value : "='" + value + "'");
    });
}

void warn(const std::string &text) {
    if (PyErr_WarnEx(PyExc_UserWarning, with_keywords(text).c_str(), 1) != 0) throw py::error_already_set();
}

void warn_of(const std::string &name, const OpenedFile &file) {
    for (const std::string &warning : file.warnings) warn(name + ": " + warning);
    notify_speckles([](const Notice &notice) { warn(words_of(notice)); }, name, file.speckles);
    if (file.bad.any()) warn(name + ": " + file.bad.text());
}

py::sequence sequence_of(const py::handle &given, const char *name, const char *wanted) {
    if (!py::isinstance<py::sequence>(given) || py::isinstance<py::str>(given))
        wrong_type(name, wanted, given);
    return py::reinterpret_borrow<py::sequence>(given);
}

void bind_objects(py::module_ &module) {
    bind_camera(module);
    bind_view(module);
    bind_ldi(module);
    bind_picture(module);
    bind_plan(module);
}

} // namespace sparselens::python
