#pragma once

// Andrews' squeezing mechanism (benchmark B1; Hairer, Wanner, Solving ODE II,
// VII.7; IFToMM A03), hand-written twice: reduced to the crank angle, and with
// seven angles and six constraints in index-1 form.
//
// Angles everywhere: absolute ones of the bodies K1 … K7 in the order
//   β, β + Θ, γ, Φ + δ, δ, Ω + ε, ε.

#include <array>

namespace steplap::peers {

enum class AndrewsVariant { test_set, a03 }; // start with Θ = 0; start with β = −0.0620

using AndrewsAngles = std::array<double, 7>; // β, Θ, γ, Φ, δ, Ω, ε, named as in the literature

struct AndrewsResult {
  AndrewsAngles angles{};
  long steps = 0;
  long evaluations = 0;
};

inline constexpr double k_andrews_end[2] = {0.03, 0.05};

// Final angles of each variant for an exactly assembled start, from an integration with 30 digits.
inline constexpr AndrewsAngles k_andrews_exact[2] = {
    {15.8107711951537, -15.7563710584118, 0.0408222401196458, -0.534730116342080, 0.524409965879954, 0.534730116342080, 1.04808074104194},
    {33.8153407213602, -33.5711553782194, 0.115158527591552, -0.404764941308129, 0.526051256322152, 0.404764941308129, 1.05727175590757}};

[[nodiscard]] double andrews_start(AndrewsVariant variant); // initial value of β, rad
[[nodiscard]] AndrewsAngles assemble_andrews(double beta);

// Computes (β̇, β̈) from y = (β, β̇), with all other coordinates eliminated.
void andrews_reduced_rates(const double* y, double* dydt);

// Computes the derivative of y = (seven absolute angles, their rates) by one dense KKT solution. Writes the multipliers to `lambda` unless
// it is null.
void andrews_kkt_rates(const double* y, double* dydt, double* lambda);
// Writes the residuals of M a + Gᵀλ − f (7 numbers) and G a − γ (6 numbers) for given accelerations.
void andrews_kkt_residual(const double* y, const double* a, const double* lambda, double* residual);

[[nodiscard]] AndrewsResult run_andrews_dop853(AndrewsVariant variant, double tolerance);
[[nodiscard]] AndrewsResult run_andrews_arkode(AndrewsVariant variant, double tolerance);
[[nodiscard]] AndrewsResult run_andrews_kkt_arkode(AndrewsVariant variant, double tolerance);
[[nodiscard]] AndrewsResult run_andrews_kkt_ida(AndrewsVariant variant, double tolerance);

} // namespace steplap::peers
