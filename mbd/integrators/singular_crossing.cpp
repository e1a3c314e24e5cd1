#include "mbd/integrators/singular_crossing.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace steplap {

namespace {

constexpr int k_max_rounds = 40, k_max_setbacks = 4;
constexpr double k_agreement = 1e-2;   // convergence: largest change of the end of the step between iterations, relative to the tolerance
constexpr double k_rounded = 2e-11;    // change between iterations that may be rounding, relative to the step length
constexpr double k_dense_share = 1e-3; // weight of the error of the collocation polynomial, relative to the error of the end of the step
constexpr double k_infinite = std::numeric_limits<double>::infinity();

struct Legendre {
  long double value, slope;
};

Legendre legendre(int n, long double x) {
  long double p = 1.0L, q = 0.0L;
  for (int k = 1; k <= n; ++k) {
    const long double r = ((2 * k - 1) * x * p - (k - 1) * q) / k;
    q = p;
    p = r;
  }
  return {p, n * (x * p - q) / (x * x - 1.0L)};
}

// Computes ∫ from..to of the Lagrange polynomials for up to four nodes; Gauss' method with two points is exact for them.
void integrate_lagrange(const double* node, int count, double from, double to, double* weight) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  for (int j = 0; j < count; ++j) {
    weight[j] = 0.0;
    for (const double x : {middle - half / std::numbers::sqrt3, middle + half / std::numbers::sqrt3}) {
      double product = half;
      for (int i = 0; i < count; ++i)
        if (i != j) product *= (x - node[i]) / (node[j] - node[i]);
      weight[j] += product;
    }
  }
}

} // namespace

// --- coefficients ------------------------------------------------------------------------------------

std::array<double, GaussTable::n> GaussTable::weights_to(double theta) const {
  std::array<double, n> w{};
  for (int i = 0; i < n; ++i) {
    double sum = 0.0;
    for (int p = n - 1; p >= 0; --p) sum = sum * theta + power[i][p] / (p + 1);
    w[i] = sum * theta;
  }
  return w;
}

std::array<double, GaussTable::n> GaussTable::weights_at(double theta) const {
  std::array<double, n> w{};
  for (int i = 0; i < n; ++i)
    for (int p = n - 1; p >= 0; --p) w[i] = w[i] * theta + power[i][p];
  return w;
}

const GaussTable& gauss_table() {
  static const GaussTable table = [] {
    constexpr int n = GaussTable::n;
    GaussTable t;
    std::array<long double, n> c{};
    for (int i = 0; i < n; ++i) {
      long double x = -portable::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
      for (int k = 0; k < 20; ++k) {
        const Legendre p = legendre(n, x);
        x -= p.value / p.slope;
      }
      c[i] = 0.5L * (1.0L + x);
      t.c[i] = static_cast<double>(c[i]);
    }
    for (int i = 0; i < n; ++i) {
      std::array<long double, n> power{};
      power[0] = 1.0L;
      int degree = 0;
      for (int j = 0; j < n; ++j) {
        if (j == i) continue;
        const long double scale = 1.0L / (c[i] - c[j]);
        for (int p = ++degree; p >= 0; --p) power[p] = ((p > 0 ? power[p - 1] : 0.0L) - c[j] * (p < degree ? power[p] : 0.0L)) * scale;
      }
      const auto integral = [&power](long double theta) {
        long double sum = 0.0L;
        for (int p = n - 1; p >= 0; --p) sum = sum * theta + power[p] / (p + 1);
        return static_cast<double>(sum * theta);
      };
      for (int j = 0; j < n; ++j) t.a[j][i] = integral(c[j]);
      t.b[i] = integral(1.0L);
      for (int p = 0; p < n; ++p) t.power[i][p] = static_cast<double>(power[p]);
    }
    return t;
  }();
  return table;
}

// --- the step ------------------------------------------------------------------------------------------

SingularCrossing::SingularCrossing(int max_dimension)
    : stride_(max_dimension), state_(static_cast<std::size_t>(k_stages) * max_dimension), rate_(state_.size()),
      work_(2 * static_cast<std::size_t>(max_dimension)) {}

double SingularCrossing::distance(Dynamics& dynamics, const Step& step, double theta) {
  const double tau = theta * step.h;
  const int m = dynamics.coordinate_count();
  double* const y = work_.data();
  std::copy(step.y0, step.y0 + step.n, y);
  for (int l = 0; l < 2 * m; ++l) y[l] += tau * step.rate0[l];
  for (int l = 0; l < m; ++l) y[l] += 0.5 * tau * tau * step.rate0[m + l];
  dynamics.rates(step.t0 + tau, y, y + stride_);
  return std::sqrt(dynamics.layout().smallest_pivot());
}

// Finds the singular position by samples of the distance from it, which decreases linearly before and increases after. Step widths are
// chosen so that a few samples suffice.
double SingularCrossing::locate(Dynamics& dynamics, const Step& step) {
  constexpr int k_most_samples = 10;
  constexpr double k_first = 0.25, k_strides = 3.0, k_near = 0.2;
  const auto between = [](double low, double d_low, double high, double d_high) {
    return (low * d_high + high * d_low) / (d_low + d_high);
  };
  const double start = distance(dynamics, step, 0.0), first = distance(dynamics, step, k_first);
  if (!(first < start)) return std::numeric_limits<double>::quiet_NaN();
  const double stride = std::max(k_first, k_first * start / (start - first) / k_strides);
  double before = k_infinite, last = start;
  for (int i = 1; i <= k_most_samples; ++i) {
    const double next = distance(dynamics, step, stride * i);
    if (next < last) {
      before = last;
      last = next;
      continue;
    }
    if (i == 1) break;
    double theta = between(stride * (i - 2), before, stride * i, next);
    for (int refinement = 0; refinement < 2; ++refinement) {
      const double low = theta - k_near * stride, high = theta + k_near * stride;
      theta = between(low, distance(dynamics, step, low), high, distance(dynamics, step, high));
    }
    return theta;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double SingularCrossing::length_with_gap_at(double ahead, double left) const {
  const auto& c = gauss_table().c;
  for (int i = k_stages / 2; i < k_stages; ++i) {
    const double h = 2.0 * ahead / (c[i - 1] + c[i]);
    if (h <= left) return h;
  }
  return 0.0;
}

void SingularCrossing::evaluate(Dynamics& dynamics, const Step& step, int stage) {
  const double t = step.t0 + gauss_table().c[stage] * step.h;
  dynamics.project(t, state(stage), 0.0);
  dynamics.rates(t, state(stage), rate(stage));
}

// Initial guess of a stage: continues from the previous stage with the rates of up to four stages before (Adams' method).
void SingularCrossing::begin_stage(Dynamics& dynamics, const Step& step, int stage) {
  constexpr int k_most = 4;
  const auto& c = gauss_table().c;
  const int count = std::min(stage + 1, k_most);
  double node[k_most], weight[k_most];
  const double* rates[k_most];
  for (int j = 0; j < count; ++j) {
    const int i = stage - 1 - j; // stage index; −1: start of the step
    node[j] = i < 0 ? 0.0 : c[i];
    rates[j] = i < 0 ? step.rate0 : rate(i);
  }
  integrate_lagrange(node, count, node[0], c[stage], weight);
  const double* const from = stage == 0 ? step.y0 : state(stage - 1);
  for (int l = 0; l < step.n; ++l) {
    double sum = 0.0;
    for (int j = 0; j < count; ++j) sum += weight[j] * rates[j][l];
    state(stage)[l] = from[l] + step.h * sum;
  }
  evaluate(dynamics, step, stage);
}

// Computes new stages and a new end of the step from the rates of the last iteration, and projects them onto the constraints.
void SingularCrossing::iterate(Dynamics& dynamics, const Step& step, double* y1) {
  const GaussTable& table = gauss_table();
  const auto combine = [&](const std::array<double, k_stages>& weights, double* y) {
    for (int l = 0; l < step.n; ++l) {
      double sum = 0.0;
      for (int j = 0; j < k_stages; ++j) sum += weights[j] * rate(j)[l];
      y[l] = step.y0[l] + step.h * sum;
    }
  };
  for (int i = 0; i < k_stages; ++i) combine(table.a[i], state(i));
  combine(table.b, y1);
  for (int i = 0; i < k_stages; ++i) evaluate(dynamics, step, i);
  dynamics.project(step.t0 + step.h, y1, 0.0);
}

// The polynomial of degree 7 through the rates of the stages has an error δ at the start of the step, where the rate is known. The end
// of the step, exact to degree 15, then has an error of δ times the relative magnitude of δ. The component of δ that violates the
// constraints is rounding and is removed.
double SingularCrossing::error_of(Dynamics& dynamics, const Step& step) {
  const auto w = gauss_table().weights_at(0.0);
  double* const off = work_.data();
  double* const whole = off + stride_;
  dynamics.rates(step.t0, step.y0, off);
  for (int l = 0; l < step.n; ++l) {
    double sum = -step.rate0[l];
    for (int j = 0; j < k_stages; ++j) sum += w[j] * rate(j)[l];
    off[l] = step.h * sum;
    whole[l] = step.h * step.rate0[l];
  }
  dynamics.project_onto_null_space(off);
  dynamics.project_onto_null_space(off + dynamics.coordinate_count());
  const double delta = step.norm(off), size = step.norm(whole);
  return std::max(size > 0.0 ? delta * delta / size : delta, k_dense_share * delta);
}

// Iterates until the end of the step no longer changes. Each iteration should gain a digit; if one does not, the change has reached
// rounding, which occasionally moves a stage far off.
bool SingularCrossing::settle(Dynamics& dynamics, const Step& step, double* y1) {
  double* const change = work_.data();
  double* const before = change + stride_;
  std::copy(step.y0, step.y0 + step.n, before);
  double previous = 0.0, size = 0.0;
  int setbacks = 0;
  for (int round = 0; round < k_max_rounds && setbacks < k_max_setbacks; ++round) {
    iterate(dynamics, step, y1);
    for (int l = 0; l < step.n; ++l) change[l] = y1[l] - before[l];
    std::copy(y1, y1 + step.n, before);
    const double now = step.norm(change);
    if (round == 0) size = now;
    if (now < k_agreement) return true;
    if (round > 1 && now > 0.5 * previous) {
      if (now < std::max(1.0, k_rounded * size)) return true;
      ++setbacks;
    }
    previous = now;
  }
  return false;
}

double SingularCrossing::cross(Dynamics& dynamics, const Step& step, double* y1) {
  try {
    for (int i = 0; i < k_stages; ++i) begin_stage(dynamics, step, i);
    if (!settle(dynamics, step, y1)) return k_infinite;
    for (int i = 0; i < k_stages; ++i) { // the stages become nodes of the event functions (EventNodes)
      evaluate(dynamics, step, i);
      step.record_stage(rate(i), gauss_table().c[i]);
    }
  } catch (const ConstraintFailure&) {
    return k_infinite;
  }
  return error_of(dynamics, step);
}

void SingularCrossing::dense(double theta, const Step& step, double* out) const {
  const auto w = gauss_table().weights_to(theta);
  for (int l = 0; l < step.n; ++l) {
    double sum = 0.0;
    for (int j = 0; j < k_stages; ++j) sum += w[j] * rate(j)[l];
    out[l] = step.y0[l] + step.h * sum;
  }
}

} // namespace steplap
