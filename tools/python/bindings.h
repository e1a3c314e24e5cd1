// Python module `steplap`: thin wrappers of the library in mbd/run/, one file per class. All computation is done by the library.
#pragma once

#include "mbd/run/report.h"

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

namespace steplap::python {

namespace py = pybind11;

/// A model object in Python.
struct PyModel {
  std::shared_ptr<const LoadedModel> loaded;
  std::shared_ptr<const std::string> source{}; ///< source text, if the model was made from a text and not from a file
};

/// Returns the model as given, for setting values in it.
[[nodiscard]] Model given_model(const PyModel& model);

/// A run with its report. NumPy arrays refer to `columns` and keep it alive.
struct PyRun {
  std::shared_ptr<const Report> report;
  std::shared_ptr<const Columns> columns;
};

/// Checks at most twenty times a second whether Ctrl-C was pressed in Python, for RunOptions::stop. Called without the interpreter lock
/// (GIL).
class Interruption {
public:
  /// Returns the text for RunOptions::stop; "" lets the run continue.
  [[nodiscard]] std::string ask();
  /// Raises KeyboardInterrupt, or the exception of a signal handler, if one occurred. Must be called with the GIL held.
  void raise_if_any();

private:
  double asked_ = 0.0; ///< time of the last check on a steady clock, s
  std::shared_ptr<py::error_already_set> raised_;
};

/// Returns "path=value" for a Python value: numbers with all digits, quoted texts, lists. Throws TypeError for other types.
[[nodiscard]] std::string override_text(const std::string& path, const py::handle& value);
/// Converts a dictionary of values, or a list of "path=value".
[[nodiscard]] std::vector<std::string> overrides_of(const py::object& given);

void add_analysis(py::module_& module);
void add_errors(py::module_& module);
void add_model(py::module_& module);
void add_run(py::module_& module);
void add_samples(py::module_& module);

} // namespace steplap::python
