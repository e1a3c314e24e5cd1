#include "mbd/integrators/methods.h"

#include <stdexcept>

namespace steplap {

std::unique_ptr<Integrator> make_integrator(const std::string& name, const Dynamics& dynamics,
                                            const IntegratorSettings& settings) {
  const int max_dimension = dynamics.system().largest_dimension();
  if (name == "rk4") return make_rk4(dynamics, settings, max_dimension);
  if (name == "tsit5") return make_tsit5(dynamics, settings, max_dimension);
  if (name == "dop853") return make_dop853(dynamics, settings, max_dimension);
  if (name == "rodas5p") return make_rodas5p(dynamics, settings, max_dimension);
  if (name == "moreau") return make_moreau(dynamics, settings, max_dimension);
  if (name == "auto") return make_automatic(dynamics, settings, max_dimension);
  throw std::invalid_argument("unknown integrator '" + name + "'");
}

} // namespace steplap
