// Properties of the integration methods that models and assessments need. Each method is a file pair in mbd/integrators and a line in
// mbd/integrators/methods.cpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace steplap {

class Dynamics;
class Integrator;
struct IntegratorSettings;

/// One integration method.
struct Method {
  const char* name;          ///< name in model files, such as "dop853"
  bool has_fixed_step;       ///< true: constant steps of length 'step'; false: steps are controlled by 'tolerance'
  bool is_time_stepping;     ///< does not locate events; requires absolute coordinates and no inner states
  bool is_for_damping;       ///< implicit, for stiffly damped systems in which explicit methods need very small steps
  bool may_step_over_storms; ///< may use time stepping for an element while its events are too dense to be located one by one
  /// Creates an integrator for systems with at most `max_dimension` state variables.
  std::unique_ptr<Integrator> (*make)(const Dynamics&, const IntegratorSettings&, int max_dimension);
};

/// Returns all methods, in the order of mbd/integrators/methods.cpp.
[[nodiscard]] const std::vector<Method>& methods();
/// Returns the names of all methods, in the same order.
[[nodiscard]] std::vector<std::string> method_names();
/// Returns the method with this name. Throws std::invalid_argument if there is none.
[[nodiscard]] const Method& method(const std::string& name);

} // namespace steplap
