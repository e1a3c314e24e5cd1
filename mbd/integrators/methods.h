// The methods by themselves; make_integrator() picks one by name.
#pragma once

#include "mbd/integrators/integrator.h"

namespace steplap {

std::unique_ptr<Integrator> make_rk4(const Dynamics&, const IntegratorSettings&, int max_dimension);
std::unique_ptr<Integrator> make_tsit5(const Dynamics&, const IntegratorSettings&, int max_dimension);
std::unique_ptr<Integrator> make_dop853(const Dynamics&, const IntegratorSettings&, int max_dimension);
std::unique_ptr<Integrator> make_automatic(const Dynamics&, const IntegratorSettings&, int max_dimension);
std::unique_ptr<Integrator> make_moreau(const Dynamics&, const IntegratorSettings&, int max_dimension);
std::unique_ptr<Integrator> make_rodas5p(const Dynamics&, const IntegratorSettings&, int max_dimension);

/// Interpolation from both ends of a step: quintic for coordinates (position, velocity, acceleration of
/// both ends), its derivative for velocities, cubic for what is behind them up to `dimension`.
void hermite_dense(int coordinates, int dimension, double theta, double h, const double* y0, const double* y1, const double* rate0,
                   const double* rate1, double* out);

} // namespace steplap
