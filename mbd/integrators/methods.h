// Constructors of the single methods, for the list in methods.cpp; other code uses make_integrator().
#pragma once

#include "mbd/integrators/integrator.h"

namespace steplap {

std::unique_ptr<Integrator> make_rk4(const Dynamics&, const IntegratorSettings&, int max_dimension);
std::unique_ptr<Integrator> make_tsit5(const Dynamics&, const IntegratorSettings&, int max_dimension);
std::unique_ptr<Integrator> make_dop853(const Dynamics&, const IntegratorSettings&, int max_dimension);
std::unique_ptr<Integrator> make_automatic(const Dynamics&, const IntegratorSettings&, int max_dimension);
std::unique_ptr<Integrator> make_moreau(const Dynamics&, const IntegratorSettings&, int max_dimension);
std::unique_ptr<Integrator> make_rodas5p(const Dynamics&, const IntegratorSettings&, int max_dimension);

/// Interpolates between both ends of a step: coordinates by the quintic polynomial with position, velocity and acceleration of both ends,
/// velocities by its derivative, all further numbers up to `dimension` by cubic Hermite polynomials. `rate0` and `rate1` are dy/dt at the
/// ends.
void hermite_dense(int coordinates, int dimension, double theta, double h, const double* y0, const double* y1, const double* rate0,
                   const double* rate1, double* out);

} // namespace steplap
