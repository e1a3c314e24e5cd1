#include "tools/python/bindings.h"

#include <pybind11/stl.h>

#include <utility>

namespace steplap::python {

namespace {

// Creates an exception class that lives as long as the interpreter.
py::object new_exception(py::module_& module, const char* name, const char* doc, const py::object& base) {
  const std::string full = std::string("steplap.") + name;
  py::object made = py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(full.c_str(), doc, base.ptr(), nullptr));
  module.attr(name) = made;
  return made;
}

struct Exceptions {
  py::object model, numerical, file;
};

// Returns the exception classes. They are never freed, because the translator may be called while the interpreter shuts down.
Exceptions& exceptions() {
  static Exceptions* const all = new Exceptions;
  return *all;
}

void raise(const py::object& type, const char* message, const std::vector<std::pair<const char*, py::object>>& fields) {
  const py::object error = type(py::str(message));
  for (const auto& [name, value] : fields) error.attr(name) = value;
  PyErr_SetObject(type.ptr(), error.ptr());
}

void translate(std::exception_ptr thrown) {
  if (!thrown) return;
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const ModelError& error) {
    raise(exceptions().model, error.what(), {{"diagnostics", py::cast(error.diagnostics())}});
  } catch (const FileError& error) {
    raise(exceptions().file, error.what(), {{"path", py::cast(error.path())}, {"line", py::cast(error.line())}});
  } catch (const NumericalFailure& error) {
    raise(exceptions().numerical, error.what(), {});
  }
}

} // namespace

void add_errors(py::module_& module) {
  py::class_<Diagnostic>(module, "Diagnostic", "One thing that is wrong with a model.")
      .def_property_readonly(
          "file", [](const Diagnostic& d) { return d.where.file; }, "the model's file")
      .def_property_readonly(
          "line", [](const Diagnostic& d) { return d.where.line; }, "from 1; 0: unknown")
      .def_property_readonly(
          "column", [](const Diagnostic& d) { return d.where.column; }, "from 1; 0: unknown")
      .def_readonly("message", &Diagnostic::message, "cause and remedy")
      .def("__str__", &Diagnostic::text)
      .def("__repr__", &Diagnostic::text);
  py::class_<Finding>(module, "Finding", "Something about a model or a run that a reader should know.")
      .def_readonly("code", &Finding::code, "for programs: what it stands for does not change")
      .def_readonly("text", &Finding::text, "one or two sentences")
      .def_property_readonly("is_warning", [](const Finding& f) { return f.level == FindingLevel::warning; })
      .def_property_readonly(
          "caps_verdict", [](const Finding& f) { return caps_verdict(f); }, "does it forbid 'hold'?")
      .def_property_readonly("file", [](const Finding& f) { return f.where.file; })
      .def_property_readonly(
          "line", [](const Finding& f) { return f.where.line; }, "from 1; 0: of no one place")
      .def("__repr__", [](const Finding& f) { return text_with_place(f); });
  const py::object error =
      new_exception(module, "Error", "What steplap raises on purpose.", py::reinterpret_borrow<py::object>(PyExc_Exception));
  exceptions().model = new_exception(module, "ModelError", "The model cannot be used as it stands: see `diagnostics`.", error);
  exceptions().numerical = new_exception(module, "NumericalFailure", "A computation could not be finished.", error);
  exceptions().file = new_exception(module, "FileError", "A file cannot be read or written: see `path` and `line`.", error);
  py::register_exception_translator(translate);
}

} // namespace steplap::python
