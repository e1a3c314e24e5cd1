// The module `steplap` of Python: thin wrappers of the room run/, one file a class. What is computed, judged and written is what the
// library computes, judges and writes; nothing is decided here.
#pragma once

#include "run/report.h"

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

namespace steplap::python {

namespace py = pybind11;

/// A model as Python holds it.
struct PyModel {
  std::shared_ptr<const LoadedModel> loaded;
  std::shared_ptr<const std::string> source{}; ///< the text that it was made from, where it was made from one and not from a file
};

/// The model as given, to set values in.
[[nodiscard]] Model given_model(const PyModel& model);

/// A run with its report; its samples as one block, which arrays of numpy look into and keep alive.
struct PyRun {
  std::shared_ptr<const Report> report;
  std::shared_ptr<const Columns> columns;
};

/// Asks Python, at most twenty times a second, whether Ctrl-C was pressed; for RunOptions::stop. Called without the interpreter's lock.
class Interruption {
public:
  /// What RunOptions::stop says: "" lets the run go on.
  [[nodiscard]] std::string ask();
  /// With the lock held: raises KeyboardInterrupt, or what a signal's handler raised, if it came to that.
  void raise_if_any();

private:
  double asked_ = 0.0; ///< s, on a steady clock
  std::shared_ptr<py::error_already_set> raised_;
};

/// "path=value" of a value of Python: numbers with all digits, texts in quotes, lists. Throws TypeError for anything else.
[[nodiscard]] std::string override_text(const std::string& path, const py::handle& value);
/// A dictionary of such, or a list of "path=value".
[[nodiscard]] std::vector<std::string> overrides_of(const py::object& given);

void add_analysis(py::module_& module);
void add_errors(py::module_& module);
void add_model(py::module_& module);
void add_run(py::module_& module);
void add_samples(py::module_& module);

} // namespace steplap::python
