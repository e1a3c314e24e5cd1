#include "tools/python/bindings.h"
#include "tools/python/pickling.h"

#include <utility>

namespace steplap::python {

namespace {

// Converts text to a Python string. Bytes of file names that are not UTF-8 become surrogate escapes.
py::object text_of(const std::string& text) {
  return py::reinterpret_steal<py::object>(PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<py::ssize_t>(text.size())));
}

void raise(const py::object& error) { PyErr_SetObject(py::type::of(error).ptr(), error.ptr()); }

void translate(std::exception_ptr thrown) {
  if (!thrown) return;
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const ModelError& error) {
    raise(py::module_::import("steplap._errors").attr("model_error")(text_of(error.what()), py::cast(error.diagnostics())));
  } catch (const FileError& error) {
    raise(py::module_::import("steplap._errors").attr("FileError")(text_of(error.what()), text_of(error.path()), error.line()));
  } catch (const NumericalFailure& error) {
    raise(py::module_::import("steplap._errors").attr("NumericalFailure")(text_of(error.what())));
  }
}

} // namespace

void add_errors(py::module_& module) {
  native_class<Diagnostic>(module, "Diagnostic", "One thing that is wrong with a model.")
      .def(py::init([](const std::string& message, const std::string& file, int line, int column) {
             return Diagnostic{{file, line, column}, message};
           }),
           py::arg("message"), py::arg("file") = "", py::arg("line") = 0, py::arg("column") = 0)
      .def_property_readonly(
          "file", [](const Diagnostic& d) { return text_of(d.where.file); }, "the model's file")
      .def_property_readonly(
          "line", [](const Diagnostic& d) { return d.where.line; }, "from 1; 0: unknown")
      .def_property_readonly(
          "column", [](const Diagnostic& d) { return d.where.column; }, "from 1; 0: unknown")
      .def_property_readonly(
          "message", [](const Diagnostic& d) { return text_of(d.message); }, "cause and remedy")
      .def(pickling_of(&Diagnostic::where, &Diagnostic::message))
      .def("__str__", [](const Diagnostic& d) { return text_of(d.text()); })
      .def("__repr__", [](const Diagnostic& d) { return text_of(d.text()); });
  native_class<Finding>(module, "Finding", "Something about a model or a run that a reader should know.")
      .def_readonly("code", &Finding::code, "for programs: what it stands for does not change")
      .def_readonly("text", &Finding::text, "one or two sentences")
      .def_property_readonly("is_warning", [](const Finding& f) { return f.level == FindingLevel::warning; })
      .def_property_readonly(
          "caps_verdict", [](const Finding& f) { return caps_verdict(f); }, "does it forbid 'hold'?")
      .def_property_readonly("file", [](const Finding& f) { return f.where.file; })
      .def_property_readonly(
          "line", [](const Finding& f) { return f.where.line; }, "from 1; 0: of no one place")
      .def(pickling_of(&Finding::code, &Finding::level, &Finding::text, &Finding::where))
      .def("__repr__", [](const Finding& f) { return text_with_place(f); });
  py::register_exception_translator(translate);
}

} // namespace steplap::python
