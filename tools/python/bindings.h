// Python module `steplap`: thin wrappers of the library in mbd/run/, one file per class. All computation is done by the library.
#pragma once

#include "mbd/run/report.h"
#include "mbd/run/result_files.h"
#include "tools/python/computation.h"

#include <pybind11/pybind11.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap::python {

/// Defines a Python class for a C++ type, with the standard metaclass instead of pybind11's, which is needed for static properties only.
template <class T> py::class_<T> native_class(py::module_& module, const char* name, const char* doc) {
  return py::class_<T>(module, name, doc, py::metaclass(reinterpret_cast<PyObject*>(&PyType_Type)));
}

/// A model object in Python.
struct PyModel {
  std::shared_ptr<const LoadedModel> loaded;
  std::shared_ptr<const std::string> source{}; ///< text of the model if it was not read from a file
};

/// Returns the model before completion, so that values can be set in it.
[[nodiscard]] Model given_model(const PyModel& model);
/// Raises each remark as a warning of Python.
void warn_of(const std::vector<std::string>& remarks);
/// Returns the equilibrium of a model. Remarks on it (remarks_on()) become warnings of Python. Throws as equilibrium_of() does.
[[nodiscard]] Equilibrium rest_of(const PyModel& model);

/// An event as a Python object.
struct PyEvent {
  double t = 0.0; ///< time, s
  std::string element, words;
};

/// Extremes of a channel with their errors, in the order of k_extremes. An empty entry is unknown.
using PyExtremes = std::array<std::optional<double>, 8>;
/// Python names of the entries of PyExtremes.
inline constexpr std::array<const char*, 8> k_extremes{"low", "t_low", "high", "t_high", "first", "final", "low_error", "high_error"};

/// A run as a Python object. NumPy arrays refer to `columns` and keep it alive.
struct PyRun {
  std::string path, name; ///< path and name of the model
  std::string verdict, distrust;
  std::vector<std::string> caps;
  std::vector<CriterionResult> criteria;
  std::vector<Finding> findings;
  double energy_residual = 0.0;
  std::vector<PyEvent> events;
  std::optional<std::string> failure;
  std::vector<std::pair<std::string, PyExtremes>> extremes; ///< extremes by channel name
  std::shared_ptr<const Columns> columns;
  std::function<std::string()> json;              ///< creates the text of summary.json
  std::function<std::vector<ResultFile>()> files; ///< creates all files of the run; refers to this object
};

/// Converts a dictionary to a list of "path=value". Returns a list of such texts unchanged. Throws TypeError.
[[nodiscard]] std::vector<std::string> overrides_of(const py::object& given);

/// Returns the value of the Python argument `estimate`. Throws ValueError for an unknown name.
[[nodiscard]] Estimating estimating_named(const std::string& name);

void add_analysis(py::module_& module);
void add_errors(py::module_& module);
void add_model(py::module_& module);
void add_run(py::module_& module);
void add_samples(py::module_& module);

} // namespace steplap::python
