// Analyses of a model without a run: vibration modes and step-lap joints.
#include "elements/step_lap/joint_view.h"
#include "mbd/rest/modes.h"
#include "mbd/run/run.h"
#include "tools/python/bindings.h"

#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>

namespace steplap::python {

namespace {

/// A vibration mode with the names of the moving bodies.
struct PyMode {
  VibrationMode mode;
  std::shared_ptr<const LoadedModel> loaded;
};

std::vector<PyMode> modes(const PyModel& model, int count, std::optional<double> near) {
  if (count < 0) throw py::value_error("count: 0 for all, or how many");
  if (near && !(*near > 0.0)) throw py::value_error("near: a frequency above zero, Hz");
  State state = rest_of(model).state;
  warn_of(remarks_on_modes(*model.loaded->system, state));
  return computed([&](const StopQuestion&) {
    std::fill(state.v.begin(), state.v.end(), 0.0);
    std::vector<PyMode> all;
    for (VibrationMode& mode : vibration_modes(*model.loaded->system, state, {count, near}).modes)
      all.push_back({std::move(mode), model.loaded});
    return all;
  });
}

py::dict shape(const PyMode& m) {
  py::dict parts;
  const System& system = *m.loaded->system;
  for (std::size_t i = 1; i < system.bodies.size(); ++i)
    parts[py::str(system.bodies[i].name)] = py::make_tuple(m.mode.shape[3 * i], m.mode.shape[3 * i + 1], m.mode.shape[3 * i + 2]);
  return parts;
}

/// A step-lap joint as a Python object; it keeps its model alive.
struct PyJoint {
  std::shared_ptr<const LoadedModel> loaded;
  JointView view;
};

std::vector<PyJoint> joints(const PyModel& model) {
  std::vector<PyJoint> all;
  for (JointView& view : joint_views(model.loaded->model, *model.loaded->system)) all.push_back({model.loaded, std::move(view)});
  return all;
}

py::list interfaces(const PyJoint& j) {
  py::list all;
  for (std::size_t i = 0; i < j.view.interfaces.size(); ++i) {
    const StepLapInterface& one = *j.view.interfaces[i];
    all.append(py::dict(py::arg("name") = one.name, py::arg("overlap") = j.view.areas[i], py::arg("count") = one.count,
                        py::arg("pressure") = j.view.pressure(i), py::arg("static_friction") = one.static_friction));
  }
  return all;
}

template <double (JointView::*capacity)(int) const> std::array<double, 3> three(const PyJoint& j) {
  return {(j.view.*capacity)(0), (j.view.*capacity)(1), (j.view.*capacity)(2)};
}

py::dict required(const PyJoint& j, double fx, double fy, double m) {
  const RequiredPressure found = j.view.required(Vec3(fx, fy, m));
  std::optional<double> pressure;
  if (!j.view.interfaces.empty()) pressure = found.u * j.view.pressure(0);
  std::optional<std::array<double, 2>> centre;
  if (found.centre) centre = {found.centre->x(), found.centre->y()};
  return py::dict(py::arg("usage") = found.u, py::arg("margin") = found.margin(), py::arg("pressure") = pressure,
                  py::arg("centre") = centre);
}

} // namespace

void add_analysis(py::module_& module) {
  native_class<PyMode>(module, "Mode", "One mode of small vibrations about equilibrium.")
      .def_property_readonly(
          "frequency", [](const PyMode& m) { return m.mode.frequency(); }, "Hz, of the damped vibration; 0 if it does not oscillate")
      .def_property_readonly(
          "natural_frequency", [](const PyMode& m) { return m.mode.natural_frequency(); }, "Hz")
      .def_property_readonly(
          "damping_ratio", [](const PyMode& m) { return m.mode.damping_ratio(); }, "below zero: it grows")
      .def_property_readonly(
          "eigenvalue", [](const PyMode& m) { return m.mode.eigenvalue; }, "1/s")
      .def_property_readonly(
          "residual", [](const PyMode& m) { return m.mode.residual; }, "unbalanced acceleration, relative to its own")
      .def_property_readonly("shape", shape,
                             "body -> (x, y, theta), complex, m and rad; the largest is 1 m, angles taken at the radius of gyration")
      .def("__repr__", [](const PyMode& m) { return "<steplap.Mode of " + std::to_string(m.mode.natural_frequency()) + " Hz>"; });
  module.attr("Model").attr("modes") =
      py::cpp_function(modes, py::name("modes"), py::is_method(module.attr("Model")), py::arg("count") = 0, py::arg("near") = py::none(),
                       "Modes of small vibrations about equilibrium, the slowest first. `count`: so many, 0 all (of large models 20); "
                       "`near`: those nearest to this frequency, Hz. Warns as equilibrium(). Raises "
                       "NumericalFailure where it does not rest.");
  native_class<PyJoint>(
      module, "Joint",
      "A step-lap joint in the reference pose. Wrenches are about the limb's centre of gravity, in the active part's axes.")
      .def_property_readonly("name", [](const PyJoint& j) { return j.view.joint->name; })
      .def_property_readonly("limb", [](const PyJoint& j) { return j.view.joint->limb; })
      .def_property_readonly("active_part", [](const PyJoint& j) { return j.view.joint->active_part; })
      .def_property_readonly("interfaces", interfaces,
                             "name, overlap of one (m^2), count, pressure (Pa), static_friction of each; none: it holds whatever it takes")
      .def_property_readonly("sliding", three<&JointView::sliding>, "friction while it slides along x, along y or turns, N, N, N m")
      .def_property_readonly("alone", three<&JointView::alone>, "largest force along x, along y or couple that it holds alone, N, N, N m")
      .def("required", required, py::arg("fx"), py::arg("fy"), py::arg("m"),
           "What a wrench on the limb takes (N, N, N m): usage of the capacity, margin, pressure at the first interface (Pa; None without "
           "interfaces) and centre of rotation "
           "(m, from the active part's centre of gravity; None at infinity). Raises NumericalFailure.")
      .def("__repr__", [](const PyJoint& j) { return "<steplap.Joint " + j.view.joint->name + ">"; });
  module.attr("Model").attr("joints") =
      py::cpp_function(joints, py::name("joints"), py::is_method(module.attr("Model")), "The step-lap joints of the model, in its order.");
}

} // namespace steplap::python
