#include "mbd/integrators/methods.h"

#include "mbd/model/method.h"

#include <algorithm>
#include <stdexcept>

namespace steplap {

const std::vector<Method>& methods() {
  static const std::vector<Method> list = {
      // name, has_fixed_step, is_time_stepping, is_for_damping, may_step_over_storms, make
      {"rk4", true, false, false, false, make_rk4},        {"tsit5", false, false, false, false, make_tsit5},
      {"dop853", false, false, false, false, make_dop853}, {"rodas5p", false, false, true, false, make_rodas5p},
      {"moreau", true, true, false, false, make_moreau},   {"auto", false, false, false, true, make_automatic},
  };
  return list;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Method& m : methods()) names.emplace_back(m.name);
  return names;
}

const Method& method(const std::string& name) {
  const auto found = std::find_if(methods().begin(), methods().end(), [&](const Method& m) { return m.name == name; });
  if (found == methods().end()) throw std::invalid_argument("unknown integrator '" + name + "'");
  return *found;
}

std::unique_ptr<Integrator> make_integrator(const std::string& name, const Dynamics& dynamics, const IntegratorSettings& settings) {
  return method(name).make(dynamics, settings, dynamics.system().largest_dimension());
}

} // namespace steplap
