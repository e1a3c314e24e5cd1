#include "mbd/io/reader.h"
#include "mbd/model/model_path.h"
#include "mbd/run/drawing.h"
#include "mbd/run/findings.h"
#include "tools/python/bindings.h"
#include "transformer/program.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>

namespace steplap::python {

namespace {

PyModel with_overrides(const PyModel& model, const py::object& values) {
  std::vector<std::string> all = model.loaded->overrides;
  const std::vector<std::string> more = overrides_of(values);
  all.insert(all.end(), more.begin(), more.end());
  const std::string path = model.loaded->path;
  return computed([&](const StopQuestion&) -> PyModel {
    if (model.source) return {load_model_text(*model.source, path, all), model.source};
    return {load_model(path, all)};
  });
}

PyModel from_text(const std::string& text, const std::string& path, const std::vector<std::string>& overrides) {
  return computed([&](const StopQuestion&) {
    return PyModel{load_model_text(text, path, overrides), std::make_shared<const std::string>(text)};
  });
}

py::dict equilibrium(const PyModel& model) {
  const Equilibrium found = rest_of(model);
  py::dict poses;
  const System& system = *model.loaded->system;
  for (std::size_t i = 1; i < system.bodies.size(); ++i)
    poses[py::str(system.bodies[i].name)] = py::make_tuple(found.state.q[3 * i], found.state.q[3 * i + 1], found.state.q[3 * i + 2]);
  return poses;
}

} // namespace

void warn_of(const std::vector<std::string>& remarks) {
  for (const std::string& remark : remarks)
    if (PyErr_WarnEx(PyExc_UserWarning, remark.c_str(), 1) != 0) throw py::error_already_set(); // warnings count as errors
}

Equilibrium rest_of(const PyModel& model) {
  Equilibrium found = computed([&](const StopQuestion&) { return equilibrium_of(*model.loaded); });
  warn_of(remarks_on(*model.loaded->system, found));
  return found;
}

Model given_model(const PyModel& model) {
  const LoadedModel& loaded = *model.loaded;
  return model.source ? parse_given_model(*model.source, loaded.path, program_catalogue(), loaded.overrides)
                      : read_given_model(loaded.path, program_catalogue(), loaded.overrides);
}

std::vector<std::string> overrides_of(const py::object& given) {
  return py::module_::import("steplap._toml").attr("overrides")(given).cast<std::vector<std::string>>();
}

void add_model(py::module_& module) {
  native_class<PyModel>(module, "Model", "A model that has been read and checked. It does not change; `with_values` makes another one.")
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
           "Where it rests: body -> (x, y, theta) of the centre of gravity, m and rad. Warns if it overturned, slid or may rest elsewhere. "
           "Raises NumericalFailure if it does not.")
      // A model is pickled as its text and overrides. Applying the overrides again to this text changes nothing.
      .def(py::pickle(
          [](const PyModel& m) { return py::make_tuple(m.source ? *m.source : m.loaded->text, m.loaded->path, m.loaded->overrides); },
          [](const py::tuple& state) {
            return from_text(state[0].cast<std::string>(), state[1].cast<std::string>(), state[2].cast<std::vector<std::string>>());
          }))
      .def("__repr__", [](const PyModel& m) { return "<steplap.Model " + m.loaded->path + ">"; });
  module.def(
      "load",
      [](const std::filesystem::path& path, const py::object& values) {
        const std::vector<std::string> overrides = overrides_of(values);
        return computed([&](const StopQuestion&) { return PyModel{load_model(path.string(), overrides)}; });
      },
      py::arg("path"), py::arg("values") = py::none(),
      "Reads a model file. `values`: laid over it, by path. Raises ModelError with all that is wrong, MissingFileError, FileError.");
  module.def(
      "loads",
      [](const std::string& text, const py::object& values, const std::filesystem::path& path) {
        return from_text(text, path.string(), overrides_of(values));
      },
      py::arg("text"), py::arg("values") = py::none(), py::arg("path") = "model.toml",
      "Reads a model from a text. `path`: what messages call it, what paths in it are relative to and what its results are named after; "
      "nothing is read from there. Raises ModelError.");
}

} // namespace steplap::python
