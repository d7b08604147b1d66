#include "python/objects.h"

#include "base/text.h"
#include "chain/notices.h"
#include "io/camera/camera_header.h"
#include "python/arrays.h"
#include "python/from_arrays.h"
#include "python/verbs.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <sparselens_docs.h>

#include <array>
#include <cmath>

namespace sparselens::python {

namespace {

using Matrix = std::array<std::array<double, 4>, 4>;
using Box = std::array<int, 4>;
Box box_of(const Imath::Box2i &box) { return {box.min.x, box.min.y, box.max.x, box.max.y}; }

std::vector<std::string> names_of(const std::vector<Channel> &channels) {
    std::vector<std::string> names;
    for (const Channel &channel : channels) names.push_back(channel.name);
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

// Binds the windows of an object.
template <typename Object, typename Get>
void bind_windows(py::class_<Object> &type, const Get &windows_of) {
    type.def_property_readonly(
            "width", [=](const Object &o) { return windows_of(o).width(); }, doc::Windows::width)
        .def_property_readonly(
            "height", [=](const Object &o) { return windows_of(o).height(); }, doc::Windows::height)
        .def_property_readonly(
            "data_window", [=](const Object &o) { return py::tuple(py::cast(box_of(windows_of(o).data))); },
            doc::Windows::data_window)
        .def_property_readonly(
            "display_window",
            [=](const Object &o) { return py::tuple(py::cast(box_of(windows_of(o).display))); },
            doc::Windows::display_window)
        .def_property_readonly(
            "pixel_aspect", [=](const Object &o) { return windows_of(o).pixel_aspect; },
            doc::Windows::pixel_aspect);
}

// Binds the channels of an object's image.
template <typename Object, typename Get>
void bind_image(py::class_<Object> &type, const Get &image_of, Access access) {
    bind_windows(type, [=](const Object &o) -> const Windows & { return image_of(o).windows; });
    type.def_property_readonly(
            "channels", [=](const Object &o) { return py::tuple(py::cast(names_of(image_of(o).channels))); },
            doc::Windows::channels)
        .def_property_readonly(
            "planes",
            [=](const py::object &self) {
                return planes_of(image_of(self.cast<const Object &>()), self, access);
            },
            doc::Image::planes)
        .def_property_readonly(
            "pixels",
            [=](const py::object &self) {
                return planes_of(image_of(self.cast<const Object &>()), self, access)
                    .attr("transpose")(1, 2, 0);
            },
            doc::Image::pixels)
        .def(
            "__getitem__",
            [=](const py::object &self, const std::string &channel) {
                return plane_of(image_of(self.cast<const Object &>()), channel, self, access);
            },
            py::arg("channel"), doc::Image::getitem);
}

void bind_camera(py::module_ &module) {
    py::class_<Camera> type(module, "Camera", doc::Camera::text);
    type.def_readonly("focal_length", &Camera::focal_length_mm, doc::Camera::focal_length)
        .def_readonly("sensor_width", &Camera::sensor_width_mm, doc::Camera::sensor_width)
        .def_readonly("fstop", &Camera::fstop, doc::Camera::fstop)
        .def_property_readonly("lens_radius", &lens_radius_of, doc::Camera::lens_radius)
        .def_readonly("supersample", &Camera::supersample, doc::Camera::supersample)
        .def_readonly("focus_distance", &Camera::focus_distance, doc::Camera::focus_distance)
        .def_readonly("scene_unit", &Camera::metres_per_unit, doc::Camera::scene_unit)
        .def_property_readonly(
            "world_to_camera",
            [](const Camera &camera) -> std::optional<Matrix> {
                if (!camera.world_to_camera) return {};
                Matrix m;
                for (int i = 0; i < 4; ++i)
                    for (int k = 0; k < 4; ++k)
                        m[std::size_t(i)][std::size_t(k)] = (*camera.world_to_camera)[i][k];
                return m;
            },
            doc::Camera::world_to_camera)
        .def_property_readonly(
            "lens_points",
            [](const Camera &camera) {
                py::list points;
                for (const Imath::V2d &p : camera.lens_points) points.append(py::make_tuple(p.x, p.y));
                return points;
            },
            doc::Camera::lens_points)
        .def("__repr__", [](const py::object &camera) {
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
    type.def_property_readonly(
            "z",
            [](const py::object &self) {
                const View &view = self.cast<const ViewObject &>().in.view;
                const Windows &w = view.image.windows;
                return shared(view.z, self, {std::size_t(w.height()), std::size_t(w.width())});
            },
            doc::View::z)
        .def_property_readonly(
            "name", [](const ViewObject &view) { return view.in.view.name; }, doc::Opened::name)
        .def_property_readonly(
            "position",
            [](const ViewObject &view) -> py::object {
                if (!view.position) return py::none();
                return py::make_tuple(view.position->x, view.position->y);
            },
            doc::View::position)
        .def_property_readonly(
            "camera", [](const ViewObject &view) { return view.in.camera; }, doc::Opened::camera)
        .def_property_readonly(
            "notes", [](const ViewObject &view) { return view.in.notes; }, doc::Opened::notes)
        .def("__repr__", [](const ViewObject &view) {
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
        type.def_property_readonly(
            name,
            [member](const py::object &self) {
                return optional_samples(self.cast<const LdiObject &>().ldi.*member, self);
            },
            text);
    };
    type.def_property_readonly(
        "begin",
        [](const py::object &self) { return shared(self.cast<const LdiObject &>().ldi.begin, self); },
        doc::Ldi::begin);
    type.def_property_readonly(
        "z", [](const py::object &self) { return shared(self.cast<const LdiObject &>().ldi.z, self); },
        doc::Ldi::z);
    samples("z_back", &Ldi::z_back, doc::Ldi::z_back);
    samples("dx", &Ldi::dx, doc::Ldi::dx);
    samples("dy", &Ldi::dy, doc::Ldi::dy);
    samples("weight", &Ldi::weight, doc::Ldi::weight);
    samples("optical", &Ldi::image_z, doc::Ldi::optical);
    samples("solid", &Ldi::solid, doc::Ldi::solid);
    type.def_property_readonly(
            "channels", [](const LdiObject &in) { return py::tuple(py::cast(names_of(in.ldi.channels))); },
            doc::Windows::channels)
        .def("__getitem__", &samples_of, py::arg("channel"), doc::Ldi::getitem)
        .def_property_readonly(
            "samples", [](const LdiObject &in) { return in.ldi.samples(); }, doc::Ldi::samples)
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
    type.def_property_readonly(
            "camera", [](const PictureObject &picture) { return read_camera(picture.header); },
            doc::Picture::camera)
        .def("__repr__",
             [](const PictureObject &picture) {
                 return text_of("Picture", {}, picture.image.windows,
                                fmt::format("{} channels", picture.image.channels.size()));
             })
        .def("_repr_png_", &png_of, doc::Picture::repr_png);
}

void bind_planned_view(py::module_ &module) {
    py::class_<PlannedViewObject> type(module, "PlannedView", doc::PlannedView::text);
    type.def_property_readonly(
            "lens_point", [](const PlannedViewObject &o) { return py::make_tuple(o.view.u.x, o.view.u.y); },
            doc::PlannedView::lens_point)
        .def_property_readonly(
            "position",
            [](const PlannedViewObject &o) {
                return py::make_tuple(o.lens.radius * o.view.u.x, o.lens.radius * o.view.u.y);
            },
            doc::PlannedView::position)
        .def_property_readonly(
            "share",
            [](const PlannedViewObject &o) {
                return double(o.view.mask.count()) / double(o.view.mask.set.size());
            },
            doc::PlannedView::share)
        .def_property_readonly(
            "uncovered", [](const PlannedViewObject &o) { return o.view.uncovered; },
            doc::PlannedView::uncovered)
        .def_property_readonly(
            "mask",
            [](const py::object &self) {
                const PixelMask &mask = self.cast<const PlannedViewObject &>().view.mask;
                return shared(mask.set, self, std::size_t(mask.width()));
            },
            doc::PlannedView::mask)
        .def_property_readonly(
            "rectangles",
            [](const PlannedViewObject &o) {
                py::list boxes;
                for (const Imath::Box2i &box : rectangles_over(o.view.mask))
                    boxes.append(py::tuple(py::cast(box_of(box))));
                return boxes;
            },
            doc::PlannedView::rectangles);
}

void bind_plan(py::module_ &module) {
    bind_planned_view(module);
    py::class_<PlanObject> type(module, "Plan", doc::Plan::text);
    type.def_property_readonly(
            "views",
            [](const PlanObject &o) {
                std::vector<PlannedViewObject> views;
                for (const PlannedView &view : o.plan.views) views.push_back({view, o.setting.lens});
                return views;
            },
            doc::Plan::views)
        .def_property_readonly(
            "share", [](const PlanObject &o) { return o.plan.share(); }, doc::Plan::share)
        .def_property_readonly(
            "full_views", [](const PlanObject &o) { return o.plan.full_views; }, doc::Plan::full_views)
        .def_property_readonly(
            "supersample", [](const PlanObject &o) { return o.plan.supersample; }, doc::Plan::supersample)
        .def_property_readonly(
            "rays",
            [](const PlanObject &o) -> py::object {
                const auto &rays = o.setting.division;
                if (!rays) return py::none();
                return py::dict(py::arg("views") = rays->views, py::arg("supersample") = rays->supersample,
                                py::arg("samples") = rays->samples, py::arg("per_render") = rays->per_render,
                                py::arg("noise_db") = -10 * std::log10(rays->noise),
                                py::arg("alone") = rays->alone);
            },
            doc::Plan::rays)
        .def_property_readonly(
            "moments",
            [](const PlanObject &o) -> std::optional<int> {
                return o.setting.moments ? std::optional(o.setting.moments->moments) : std::nullopt;
            },
            doc::Plan::moments)
        .def_property_readonly(
            "motion",
            [](const PlanObject &o) -> std::optional<double> {
                return o.setting.moments ? std::optional(o.setting.moments->motion) : std::nullopt;
            },
            doc::Plan::motion)
        .def_property_readonly(
            "noise_db", [](const PlanObject &o) { return -10 * std::log10(o.plan.noise); },
            doc::Plan::noise_db)
        .def_property_readonly(
            "overscan",
            [](const PlanObject &o) {
                const OverscanNeed &need = o.plan.overscan;
                return py::make_tuple(need.left, need.top, need.right, need.bottom);
            },
            doc::Plan::overscan);
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

void warn_of(const std::string &name, const std::vector<std::string> &warnings, std::size_t speckles,
             const InvalidValues &bad) {
    for (const std::string &warning : warnings) warn(name + ": " + warning);
    notify_speckles([](const Notice &notice) { warn(words_of(notice)); }, name, speckles);
    if (bad.any()) warn(name + ": " + bad.text());
}

void bind_objects(py::module_ &module) {
    bind_camera(module);
    bind_view(module);
    bind_ldi(module);
    bind_picture(module);
    bind_plan(module);
}

} // namespace sparselens::python
