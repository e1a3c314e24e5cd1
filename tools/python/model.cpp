#include "mbd/io/reader.h"
#include "mbd/model/model_path.h"
#include "mbd/run/drawing.h"
#include "mbd/run/findings.h"
#include "tools/python/bindings.h"
#include "transformer/program.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>

namespace steplap::python {

namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string value_text(const std::string& path, const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::str>(value)) return quoted(value.cast<std::string>());
  if (py::hasattr(value, "tolist")) return value_text(path, value.attr("tolist")()); // NumPy numbers and arrays
  if (py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value)) return py::repr(value).cast<std::string>();
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    std::string text;
    for (const py::handle item : value) text += (text.empty() ? "[" : ", ") + value_text(path, item);
    return text.empty() ? "[]" : text + "]";
  }
  throw py::type_error("'" + path + "' takes a number, a text such as \"12 mm\", true or false, or a list of these");
}

PyModel with_overrides(const PyModel& model, const py::object& values) {
  std::vector<std::string> all = model.loaded->overrides;
  const std::vector<std::string> more = overrides_of(values);
  all.insert(all.end(), more.begin(), more.end());
  const std::string path = model.loaded->path;
  const py::gil_scoped_release unlocked;
  if (model.source) return {load_model_text(*model.source, path, all), model.source};
  return {load_model(path, all)};
}

py::dict equilibrium(const PyModel& model) {
  Equilibrium found;
  {
    const py::gil_scoped_release unlocked;
    found = equilibrium_of(*model.loaded);
  }
  py::dict poses;
  const System& system = *model.loaded->system;
  for (std::size_t i = 1; i < system.bodies.size(); ++i)
    poses[py::str(system.bodies[i].name)] = py::make_tuple(found.state.q[3 * i], found.state.q[3 * i + 1], found.state.q[3 * i + 2]);
  return poses;
}

} // namespace

std::string Interruption::ask() {
  constexpr double k_between = 0.05; // s; too short to be noticed by a user, and long compared with the cost of a check
  const double now = seconds();
  if (now - asked_ < k_between) return "";
  asked_ = now;
  const py::gil_scoped_acquire locked;
  if (!raised_ && PyErr_CheckSignals() != 0) raised_ = std::make_shared<py::error_already_set>();
  return raised_ ? "interrupted" : "";
}

void Interruption::raise_if_any() {
  if (raised_) throw py::error_already_set(*raised_);
}

std::string override_text(const std::string& path, const py::handle& value) { return path + "=" + value_text(path, value); }

Model given_model(const PyModel& model) {
  const LoadedModel& loaded = *model.loaded;
  return model.source ? parse_given_model(*model.source, loaded.path, program_catalogue(), loaded.overrides)
                      : read_given_model(loaded.path, program_catalogue(), loaded.overrides);
}

std::vector<std::string> overrides_of(const py::object& given) {
  std::vector<std::string> texts;
  if (given.is_none()) return texts;
  if (!py::isinstance<py::dict>(given)) return given.cast<std::vector<std::string>>();
  for (const auto& [path, value] : given.cast<py::dict>()) texts.push_back(override_text(path.cast<std::string>(), value));
  return texts;
}

void add_model(py::module_& module) {
  py::class_<PyModel>(module, "Model", "A model that has been read and checked. It does not change; `with_values` makes another one.")
      .def_property_readonly(
          "path", [](const PyModel& m) { return m.loaded->path; }, "of its file, as given")
      .def_property_readonly("title", [](const PyModel& m) { return m.loaded->model.header.title; })
      .def_property_readonly(
          "text", [](const PyModel& m) { return m.loaded->text; }, "the model as TOML that stands alone")
      .def_property_readonly(
          "overrides", [](const PyModel& m) { return m.loaded->overrides; }, "laid over the file, 'path=value'")
      .def_property_readonly(
          "findings", [](const PyModel& m) { return findings_of(*m.loaded); }, "what is unusual about it, before any run")
      .def_property_readonly(
          "channels",
          [](const PyModel& m) {
            py::dict all;
            for (const Channel& channel : m.loaded->system->channels) all[py::str(channel.name)] = channel.unit;
            return all;
          },
          "names of all channels, with their SI units")
      .def_property_readonly(
          "drawing_text", [](const PyModel& m) { return drawing_json(m.loaded->model, *m.loaded->views); },
          "the text of drawing.json: docs/reference/results.md")
      .def(
          "value", [](const PyModel& m, const std::string& path) { return number_of(m.loaded->model, path); }, py::arg("path"),
          "A number of the model by its path, in SI: value('body.tank.mass').")
      .def(
          "unit", [](const PyModel& m, const std::string& path) { return unit_of(m.loaded->model, path); }, py::arg("path"),
          "The SI unit of that number; '*': any.")
      .def("with_values", with_overrides, py::arg("values"),
           "The same model with other values: {'element.rope.stiffness': '2 MN/m', 'simulation.end': 0.5}. Raises ModelError.")
      .def("equilibrium", equilibrium,
           "Where it rests: body -> (x, y, theta) of the centre of gravity, m and rad. Raises NumericalFailure if it does not.")
      .def("__repr__", [](const PyModel& m) { return "<steplap.Model " + m.loaded->path + ">"; });
  module.def(
      "load",
      [](const std::string& path, const py::object& values) {
        const std::vector<std::string> overrides = overrides_of(values);
        const py::gil_scoped_release unlocked;
        return PyModel{load_model(path, overrides)};
      },
      py::arg("path"), py::arg("values") = py::none(),
      "Reads a model file. `values`: laid over it, by path. Raises ModelError with all that is wrong, FileError.");
  module.def(
      "loads",
      [](const std::string& text, const py::object& values, const std::string& path) {
        const std::vector<std::string> overrides = overrides_of(values);
        const py::gil_scoped_release unlocked;
        return PyModel{load_model_text(text, path, overrides), std::make_shared<const std::string>(text)};
      },
      py::arg("text"), py::arg("values") = py::none(), py::arg("path") = "model.toml",
      "Reads a model from a text. `path`: what messages call it, what paths in it are relative to and what its results are named after; "
      "nothing is read from there. "
      "Raises ModelError.");
}

} // namespace steplap::python
