#include "python/keywords.h"

#include "base/error.h"
#include "base/text.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>

namespace sparselens::python {

namespace {

std::string type_name(const py::handle &object) {
    return py::str(py::type::handle_of(object).attr("__name__"));
}

} // namespace

void wrong_type(const char *name, const char *wanted, const py::handle &found) {
    throw py::type_error(fmt::format("{}: must be {}, not {}", name, wanted, type_name(found)));
}

namespace {
// The numbers of a sequence of length `count`.
template <typename Number>
std::vector<Number> numbers(const py::object &object, const char *name, std::size_t count,
                            const char *wanted) {
    std::vector<Number> found;
    try {
        found = object.cast<std::vector<Number>>();
    } catch (const py::cast_error &) {
        if (!py::isinstance<py::sequence>(object) || py::isinstance<py::str>(object))
            wrong_type(name, wanted, object);
        throw py::type_error(
            fmt::format("{}: must be {}, not {}", name, wanted, std::string(py::str(object))));
    }
    if (found.size() != count) Keywords::refuse(name, wanted, py::str(object));
    return found;
}

bool is_bool(const py::handle &object) { return PyBool_Check(object.ptr()) != 0; }
} // namespace

Keywords::Keywords(const char *function, const py::kwargs &given) : function_(function) {
    for (const auto &[name, value] : given) left_[name] = value;
}

py::object Keywords::take(const char *name) {
    known_.emplace_back(name);
    if (!left_.contains(name)) return py::none();
    py::object value = left_[name];
    if (!value.is_none()) given_.emplace_back(name);
    PyDict_DelItemString(left_.ptr(), name);
    return value;
}

bool Keywords::flag(const char *name) {
    const py::object value = take(name);
    if (value.is_none()) return false;
    if (!is_bool(value)) wrong_type(name, "True or False", value);
    return value.ptr() == Py_True;
}

std::optional<double> Keywords::number(const char *name, NumberRange range) {
    const py::object object = take(name);
    if (object.is_none()) return {};
    if (is_bool(object)) wrong_type(name, "a number", object);
    const double value = PyFloat_AsDouble(object.ptr());
    if (PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        wrong_type(name, "a number", object);
    }
    if (range.holds(value)) return value;
    refuse(name, range.words, fmt::format("{:g}", value));
}

std::optional<int> Keywords::whole(const char *name, int least, int most) {
    const py::object object = take(name);
    if (object.is_none()) return {};
    if (is_bool(object) || PyIndex_Check(object.ptr()) == 0) wrong_type(name, "a whole number", object);
    const Py_ssize_t value = PyNumber_AsSsize_t(object.ptr(), nullptr); // clipped if it is larger
    if (value < least || value > most)
        refuse(name, fmt::format("from {} to {}", least, most), py::str(object));
    return int(value);
}

std::string Keywords::text(const char *name) {
    const py::object object = take(name);
    if (object.is_none()) return {};
    if (PyUnicode_Check(object.ptr()) == 0) wrong_type(name, "a string", object);
    return object.cast<std::string>();
}

std::string Keywords::path(const char *name) {
    const py::object object = take(name);
    return object.is_none() ? std::string() : path_of(object, name);
}

std::string Keywords::list(const char *name) {
    const py::object object = take(name);
    if (object.is_none()) return {};
    if (py::isinstance<py::str>(object)) return object.cast<std::string>();
    if (!py::isinstance<py::sequence>(object)) wrong_type(name, "a str, or a sequence of str", object);
    std::string all;
    for (const py::handle &item : py::reinterpret_borrow<py::sequence>(object)) {
        if (!py::isinstance<py::str>(item)) wrong_type(name, "a str, or a sequence of str", item);
        all += (all.empty() ? "" : ",") + item.cast<std::string>();
    }
    return all;
}

std::optional<Imath::V2d> Keywords::pair(const char *name) {
    const py::object object = take(name);
    if (object.is_none()) return {};
    const auto v = numbers<double>(object, name, 2, "two numbers (x, y)");
    if (!std::isfinite(v[0]) || !std::isfinite(v[1])) refuse(name, "two finite numbers", py::str(object));
    return Imath::V2d(v[0], v[1]);
}

std::optional<Imath::V2i> Keywords::pixel(const char *name) {
    const py::object object = take(name);
    if (object.is_none()) return {};
    const auto v = numbers<int>(object, name, 2, "two whole numbers (x, y)");
    return Imath::V2i(v[0], v[1]);
}

std::optional<Imath::Box2i> Keywords::box(const char *name) {
    const py::object object = take(name);
    if (object.is_none()) return {};
    const char *wanted = "left, top, right and bottom in whole pixels, the last ones included";
    const auto v = numbers<int>(object, name, 4, wanted);
    if (v[0] > v[2] || v[1] > v[3]) refuse(name, wanted, py::str(object));
    return Imath::Box2i({v[0], v[1]}, {v[2], v[3]});
}

// The value as text; empty if it is not given.
std::optional<std::string> Keywords::text_of(const Parameter &row, const char *name) {
    const auto written = [](const auto &value, const auto &write) {
        return value ? std::optional<std::string>(write(*value)) : std::nullopt;
    };
    const auto whole_text = [](const auto &value) { return fmt::to_string(value); };
    const auto if_filled = [](std::string text) {
        return text.empty() ? std::nullopt : std::optional(std::move(text));
    };
    switch (row.form) {
    case ParameterForm::flag: return flag(name) ? std::optional<std::string>("") : std::nullopt;
    case ParameterForm::whole: return written(whole(name, row.least, row.most), whole_text);
    case ParameterForm::number:
        if (row.or_share && left_.contains(name) && py::isinstance<py::str>(left_[name])) return text(name);
        return written(number(name, row.range), whole_text);
    case ParameterForm::list: return if_filled(list(name));
    case ParameterForm::file: return if_filled(path(name));
    case ParameterForm::ldi: return {}; // an object, which the caller takes
    case ParameterForm::pair:
        return written(pair(name), [](const Imath::V2d &v) { return fmt::format("{},{}", v.x, v.y); });
    case ParameterForm::pixel:
        return written(pixel(name), [](const Imath::V2i &v) { return fmt::format("{},{}", v.x, v.y); });
    case ParameterForm::box:
        return written(box(name), [](const Imath::Box2i &v) {
            return fmt::format("{},{},{},{}", v.min.x, v.min.y, v.max.x, v.max.y);
        });
    default: return if_filled(text(name));
    }
}

void Keywords::parameter(const Parameter &row, const std::function<bool(const std::string &)> &put) {
    const std::string name = keyword_of(row.name);
    const auto text = text_of(row, name.c_str());
    if (text && !put(*text)) refuse(name.c_str(), row.wanted, *text);
}

void Keywords::refuse(const char *name, const std::string &wanted, const std::string &found) {
    throw UsageError(fmt::format("{}: must be {}, not {}", name, wanted, found));
}

bool Keywords::is_given(const std::string &name) const { return is_among(given_, name); }

void Keywords::done() const {
    for (const auto &item : left_) {
        const std::string name = py::str(item.first), nearest = nearest_word(name, known_);
        throw py::type_error(fmt::format("{}() has no keyword argument '{}'{}", function_, name,
                                         nearest.empty() ? "" : "; did you mean " + nearest + "?"));
    }
    check_together([this](const std::string &name) { return is_given(name); });
}

LensValues lens_values(Keywords &keywords) {
    LensValues lens;
    keywords.parameters(lens_parameters(), lens);
    return lens;
}

PictureChoice picture_choice(Keywords &keywords) {
    PictureChoice picture;
    keywords.parameters(choice_parameters(), picture);
    keywords.parameters(kind_parameters(), picture);
    return picture;
}

DepthOptions depth_options(Keywords &keywords) {
    DepthOptions depth{.picture = picture_choice(keywords)};
    keywords.parameters(depth_parameters(), depth);
    keywords.parameters(photograph_parameters(), depth);
    return depth;
}

OpenOptions file_options(Keywords &keywords) {
    OpenOptions options{lens_values(keywords), depth_options(keywords)};
    keywords.parameters(depth_file_parameters(), options.depth.picture);
    return options;
}

std::string path_of(const py::object &path, const char *name) {
    PyObject *bytes = nullptr;
    if (PyUnicode_FSConverter(path.ptr(), &bytes) == 0) {
        PyErr_Clear();
        wrong_type(name, "a file name (str or os.PathLike)", path);
    }
    const auto owned = py::reinterpret_steal<py::object>(bytes);
    return PyBytes_AsString(bytes);
}

} // namespace sparselens::python
