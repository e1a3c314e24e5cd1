// The integration methods there are, as far as a model and whoever judges a run have to know them. The list itself stands
// with the methods (mbd/integrators/methods.cpp): a method is a file pair and a line there.
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
  const char* name;          ///< as a model file writes it: "dop853"
  bool has_fixed_step;       ///< steps as long as 'step' says; else it chooses them by 'tolerance'
  bool is_time_stepping;     ///< goes over events without locating them; in absolute coordinates, without inner states
  bool is_for_damping;       ///< for scenes that are damped faster than they move: what others make small steps for
  bool may_step_over_storms; ///< an element whose events crowd may be gone over by time stepping
  /// For systems of at most `max_dimension` packed numbers.
  std::unique_ptr<Integrator> (*make)(const Dynamics&, const IntegratorSettings&, int max_dimension);
};

/// All of them, in the order of mbd/integrators/methods.cpp.
[[nodiscard]] const std::vector<Method>& methods();
/// Their names, in that order.
[[nodiscard]] std::vector<std::string> method_names();
/// Throws std::invalid_argument for a name that is none.
[[nodiscard]] const Method& method(const std::string& name);

} // namespace steplap
