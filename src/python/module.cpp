// The compiled module _sparselens, which the package sparselens (__init__.py) imports.
#include "base/error.h"
#include "chain/take_moments.h"
#include "io/files/memory_limit.h"
#include "python/job.h"
#include "python/keywords.h"
#include "python/objects.h"
#include "python/verbs.h"

#include <ImfThreading.h>
#include <pybind11/stl.h>
#include <sparselens_docs.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <memory>
#include <string>

namespace sparselens::python {

namespace {

PyObject *error_type = nullptr, *usage_error_type = nullptr;

void translate(std::exception_ptr thrown) {
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const UsageError &error) {
        PyErr_SetString(usage_error_type, with_keywords(error.what()).c_str());
    } catch (const Error &error) {
        PyErr_SetString(error_type, with_keywords(error.what()).c_str());
    }
}

// An exception type that lives as long as the process.
PyObject *exception_type(py::module_ &module, const char *name, PyObject *base, const char *text) {
    PyObject *type =
        PyErr_NewExceptionWithDoc((std::string("sparselens.") + name).c_str(), text, base, nullptr);
    if (type == nullptr) throw py::error_already_set();
    module.attr(name) = py::reinterpret_borrow<py::object>(type);
    return type;
}

void set_limits(const py::kwargs &given) {
    static std::unique_ptr<tbb::global_control> limit;
    Keywords keywords("set_limits", given);
    const auto threads = keywords.whole("threads", 0, 1 << 16);
    const auto bytes =
        keywords.number("max_memory", {"a number of at least 0, or inf", [](double v) { return v >= 0; }});
    keywords.done();
    if (threads) {
        const int count = *threads > 0 ? *threads : tbb::info::default_concurrency();
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      std::size_t(count));
        Imf::setGlobalThreadCount(count > 1 ? count : 0);
    }
    constexpr double most = 0x1p60;
    if (bytes)
        set_memory_limit(*bytes < 1 ? std::optional<std::uint64_t>() : std::uint64_t(std::min(*bytes, most)));
}

// The table of parameters, with which a test compares the stubs: name, the function that takes it, group, words, and
// what a value must be.
py::list parameters() {
    py::list rows;
    for (const Parameter *row : picture_parameters()) {
        constexpr const char *calls[] = {"open_ldi", "gather", "write", ""};
        py::dict facts;
        facts["name"] = keyword_of(row->name);
        facts["call"] = calls[int(row->python)];
        facts["group"] = row->group;
        facts["words"] = row->words;
        facts["wanted"] = row->wanted;
        rows.append(facts);
    }
    return rows;
}

// Before version 2.12, pybind11 reads wrong values from arrays of numpy 2. Without numpy nothing is refused here; the
// functions that need it say so.
void refuse_unknown_numpy() {
#if PYBIND11_VERSION_HEX < 0x020c0000
    try {
        if (std::stoi(py::module_::import("numpy").attr("__version__").cast<std::string>()) < 2) return;
    } catch (const py::error_already_set &) {
        return;
    }
    throw py::import_error(
        "sparselens was built with a pybind11 that knows numpy 1 alone: install numpy 1, or "
        "build with pybind11 2.12 or later");
#endif
}

} // namespace

} // namespace sparselens::python

PYBIND11_MODULE(_sparselens, module) {
    using namespace sparselens::python;
    refuse_unknown_numpy();
    py::options options;
    options.disable_function_signatures(); // the docstrings begin with signatures, as Python writes them
    module.doc() = doc::module;
    module.attr("__version__") = SPARSELENS_VERSION;
    error_type = exception_type(module, "Error", PyExc_RuntimeError, doc::Error::text);
    usage_error_type = exception_type(module, "UsageError", PyExc_ValueError, doc::UsageError::text);
    py::register_exception_translator(&translate);
    bind_objects(module);
    bind_verbs(module);
    module.def("_parameters", &parameters);
    module.def("set_limits", &set_limits, doc::set_limits);
    py::module_::import("atexit").attr("register")(py::cpp_function([] {
        gather_device().release();
        warp_device().release();
    }));
}

namespace sparselens::python {

namespace {

// The request that the keywords make.
struct GatherArguments : PictureRequest {
    py::object keep_holdout = {}, progress = {}; // the former keeps `opened_holdout` alive
};

GatherArguments arguments_from(const py::kwargs &given) {
    Keywords keywords("gather", given);
    GatherArguments arguments;
    arguments.keep_holdout = keywords.take("holdout");
    if (!arguments.keep_holdout.is_none())
        arguments.opened_holdout = &argument<OpenedLdi>(arguments.keep_holdout, "holdout", "an Ldi");
    keywords.parameters<PictureRequest>(gather_parameters(), arguments);
    keywords.parameters(look_parameters(), arguments.looks);
    keywords.parameters(window_parameters(), arguments.windows);
    arguments.lens = lens_values(keywords);
    arguments.progress = keywords.take("progress");
    keywords.done();
    check_method(arguments, [&](const std::string &parameter) { return keywords.is_given(parameter); });
    return arguments;
}

} // namespace

PictureObject gather(const py::object &ldi, const py::kwargs &given) {
    const GatherArguments arguments = arguments_from(given);
    const std::vector<const OpenedLdi *> in =
        several<OpenedLdi>(ldi, "ldi", "an Ldi, or a sequence of the moments of a shutter");
    return job_with_notices<PictureObject>(
        arguments.progress, [&](Progress &progress, const Notify &notify) -> PictureObject {
            TakenPicture made = take_moments(in, arguments, {progress, notify, &gather_device()});
            return {std::move(made.image), std::move(made.header)};
        });
}

} // namespace sparselens::python
