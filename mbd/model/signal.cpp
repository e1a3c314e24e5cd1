#include "mbd/model/signal.h"

#include "mbd/base/portable_math.h"
#include "mbd/tape/sine_lanes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace steplap {

namespace {

// Value, first two derivatives, and integrals from the start of the piece, at time τ after it.
struct PieceJet {
  double value = 0.0, rate = 0.0, second_rate = 0.0, integral = 0.0, double_integral = 0.0;
};

constexpr double k_small_angle = 0.5; // rad

// Returns sin x − x without cancellation.
double sine_minus_argument(double x) {
  if (std::abs(x) > k_small_angle) return portable::sin(x) - x;
  const double y = x * x;
  // Taylor series; for |x| ≤ 0.5 the first omitted term, x¹⁷/17!, is below 1e-19 of the first.
  return x * y *
         (-1.0 / 6 + y * (1.0 / 120 +
                          y * (-1.0 / 5040 + y * (1.0 / 362880 + y * (-1.0 / 39916800 + y * (1.0 / 6227020800.0 - y / 1307674368000.0))))));
}

// Adds one harmonic. With x = ωτ, s and c are sine and cosine of x/2, `lag` is sin x − x:
//
//   cos(x+φ) = cos φ cos x − sin φ sin x
//   ∫ = A/ω [cos φ sin x − sin φ (1−cos x)],   ∬ = A/ω² [cos φ (1−cos x) + sin φ (sin x − x)]
template <bool has_integrals> void add_harmonic(const Signal::Harmonic& h, double s, double c, double lag, PieceJet& jet) {
  const double sine = 2.0 * s * c, versine = 2.0 * s * s, cosine = 1.0 - versine;
  const double value = h.amplitude * (h.cos_phase * cosine - h.sin_phase * sine);
  const double slope = -h.amplitude * (h.sin_phase * cosine + h.cos_phase * sine);
  jet.value += value;
  jet.rate += h.frequency * slope;
  jet.second_rate -= h.frequency * h.frequency * value;
  if constexpr (!has_integrals) return;
  jet.integral += h.integral_scale * (h.cos_phase * sine - h.sin_phase * versine);
  double bracket = h.cos_phase * versine;
  if (h.sin_phase != 0.0) bracket += h.sin_phase * lag;
  jet.double_integral += h.double_integral_scale * bracket;
}

constexpr std::size_t k_block = 8; // harmonics per vectorised call

// Adds k_block harmonics. The result is bit-identical to that of add_harmonic().
template <bool has_integrals> void add_block(const Signal::Harmonic* h, double tau, PieceJet& jet) {
  double x[k_block], half[k_block], s[k_block], c[k_block], lag[k_block] = {}, unused[k_block];
  for (std::size_t i = 0; i < k_block; ++i) {
    x[i] = h[i].frequency * tau;
    half[i] = 0.5 * x[i];
  }
  sin_cos_of_block(half, s, c);
  if constexpr (has_integrals) {
    sin_cos_of_block(x, lag, unused);
    for (std::size_t i = 0; i < k_block; ++i) lag[i] = std::abs(x[i]) > k_small_angle ? lag[i] - x[i] : sine_minus_argument(x[i]);
  }
  for (std::size_t i = 0; i < k_block; ++i) add_harmonic<has_integrals>(h[i], s[i], c[i], lag[i], jet);
}

template <bool has_integrals> void add_harmonics(const std::vector<Signal::Harmonic>& harmonics, double tau, PieceJet& jet) {
  std::size_t i = 0;
  for (; i + k_block <= harmonics.size(); i += k_block) add_block<has_integrals>(&harmonics[i], tau, jet);
  for (; i < harmonics.size(); ++i) {
    const double x = harmonics[i].frequency * tau;
    const auto [s, c] = portable::sin_cos(0.5 * x);
    const bool has_lag = has_integrals && harmonics[i].sin_phase != 0.0;
    add_harmonic<has_integrals>(harmonics[i], s, c, has_lag ? sine_minus_argument(x) : 0.0, jet);
  }
}

void add_polynomial(const double* c, double tau, PieceJet& jet) {
  jet.value = c[0] + tau * (c[1] + tau * (c[2] + tau * c[3]));
  jet.rate = c[1] + tau * (2.0 * c[2] + tau * 3.0 * c[3]);
  jet.second_rate = 2.0 * c[2] + 6.0 * c[3] * tau;
  jet.integral = tau * (c[0] + tau * (c[1] / 2 + tau * (c[2] / 3 + tau * (c[3] / 4))));
  jet.double_integral = tau * tau * (c[0] / 2 + tau * (c[1] / 6 + tau * (c[2] / 12 + tau * (c[3] / 20))));
}

// Moments F_n = ∫₀¹ uⁿ e^{ixu} du for two consecutive n.
struct Moments {
  double real[2] = {0.0, 0.0}, imaginary[2] = {0.0, 0.0};
};

// Power series F_n = Σ (ix)^k / (k! (n+k+1)), which is accurate for |x| ≤ max(2, n/2).
void add_moment_series(int n, double x, double& real, double& imaginary) {
  double term = 1.0; // x^k / k!
  for (int k = 0; k < 80 && std::abs(term) > 1e-20; ++k) {
    const double part = (k % 4 < 2 ? term : -term) / (n + k + 1);
    (k % 2 == 0 ? real : imaginary) += part;
    term *= x / (k + 1);
  }
}

// Returns F_n and F_{n+1}. For larger |x| they are computed by integration by parts, upwards from n = 0: F_n = (e^{ix} − n F_{n−1}) / (ix).
Moments moments(int n, double x) {
  Moments m;
  if (std::abs(x) <= std::max(2.0, 0.5 * n)) {
    for (int j = 0; j < 2; ++j) add_moment_series(n + j, x, m.real[j], m.imaginary[j]);
    return m;
  }
  const auto [s, c] = portable::sin_cos(x);
  double real = s / x, imaginary = (1.0 - c) / x;
  for (int k = 1; k <= n + 1; ++k) {
    if (k == n + 1) m.real[0] = real, m.imaginary[0] = imaginary;
    const double next = (s - k * imaginary) / x;
    imaginary = (k * real - c) / x;
    real = next;
  }
  m.real[1] = real;
  m.imaginary[1] = imaginary;
  return m;
}

double power(double x, int n) {
  double result = 1.0;
  for (; n > 0; --n) result *= x;
  return result;
}

// Adds one modulated harmonic: ∫ τⁿ cos(ωτ+φ) = τⁿ⁺¹ Re e^{iφ} F_n, ∬ = ∫ (τ−s) sⁿ cos = τⁿ⁺² Re e^{iφ} (F_n − F_n+1).
void add_modulated(const Signal::Modulated& m, double tau, bool has_integrals, PieceJet& jet) {
  const int n = m.power;
  const double x = m.frequency * tau;
  const auto [s, c] = portable::sin_cos(0.5 * x);
  const double sine = 2.0 * s * c, cosine = 1.0 - 2.0 * s * s;
  const double wave = m.amplitude * (m.cos_phase * cosine - m.sin_phase * sine);
  const double slope = -m.amplitude * m.frequency * (m.sin_phase * cosine + m.cos_phase * sine);
  const double p = power(tau, n), p1 = n > 0 ? n * power(tau, n - 1) : 0.0;
  const double p2 = n > 1 ? n * (n - 1) * power(tau, n - 2) : 0.0;
  jet.value += p * wave;
  jet.rate += p1 * wave + p * slope;
  jet.second_rate += p2 * wave + 2.0 * p1 * slope - m.frequency * m.frequency * p * wave;
  if (!has_integrals) return;
  const Moments f = moments(n, x);
  const double first = m.cos_phase * f.real[0] - m.sin_phase * f.imaginary[0];
  const double second = m.cos_phase * (f.real[0] - f.real[1]) - m.sin_phase * (f.imaginary[0] - f.imaginary[1]);
  jet.integral += m.amplitude * p * tau * first;
  jet.double_integral += m.amplitude * p * tau * tau * second;
}

PieceJet evaluate(const Signal::Piece& piece, double tau, bool has_integrals = true) {
  const double* c = piece.c;
  PieceJet jet;
  if (piece.is_level) {
    jet.value = c[0];
    jet.integral = tau * c[0];
    jet.double_integral = tau * tau * (c[0] / 2);
  } else {
    add_polynomial(c, tau, jet);
  }
  if (has_integrals) add_harmonics<true>(piece.harmonics, tau, jet);
  else add_harmonics<false>(piece.harmonics, tau, jet);
  for (const Signal::Modulated& m : piece.modulated) add_modulated(m, tau, has_integrals, jet);
  return jet;
}

// Returns a bound of |f| on the piece up to τ, as the sum of the absolute terms, for estimating rounding errors.
double magnitude(const Signal::Piece& piece, double tau) {
  double sum = 0.0;
  for (int i = 3; i >= 0; --i) sum = sum * tau + std::abs(piece.c[i]);
  for (const Signal::Harmonic& h : piece.harmonics) sum += std::abs(h.amplitude);
  for (const Signal::Modulated& m : piece.modulated) sum += std::abs(m.amplitude) * power(tau, m.power);
  return sum;
}

// Returns the mean of f over [a, b] by Gauss quadrature with four points per subinterval (exact to degree 7). A wave of angular frequency
// `fastest` turns by at most one radian in a subinterval, so the relative error is below 1e-8.
template <class F> double gauss_mean(double a, double b, double fastest, const F& f) {
  constexpr double k_place[] = {0.06943184420297371, 0.33000947820757187};
  constexpr double k_weight[] = {0.17392742256872693, 0.32607257743127307};
  constexpr double k_most_stretches = 256.0; // limit for higher frequencies, whose mean is negligible compared with that of one turn
  const int count = static_cast<int>(std::clamp(std::ceil(fastest * (b - a)), 1.0, k_most_stretches));
  const double h = (b - a) / count;
  double sum = 0.0;
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < 2; ++k) sum += k_weight[k] * (f(a + (i + k_place[k]) * h) + f(a + (i + 1.0 - k_place[k]) * h));
  return sum / count;
}

// Returns sin x / x.
double sinc(double x) {
  return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : portable::sin(x) / x; // truncation error below 1e-18
}

// Returns the mean of a piece between τ = a and b. With midpoint m and half length d, odd powers about m cancel, and the mean of a harmonic
// is its value at m times sin(ωd)/(ωd). No accuracy is lost for short intervals.
double mean_of(const Signal::Piece& piece, double a, double b) {
  const double m = 0.5 * (a + b), d = 0.5 * (b - a);
  const double* const c = piece.c;
  double sum = c[0] + m * (c[1] + m * (c[2] + m * c[3])) + (c[2] + 3.0 * c[3] * m) * (d * d / 3.0);
  for (const Signal::Harmonic& h : piece.harmonics) {
    const auto [s, cosine] = portable::sin_cos(h.frequency * m);
    sum += h.amplitude * (h.cos_phase * cosine - h.sin_phase * s) * sinc(h.frequency * d);
  }
  for (const Signal::Modulated& wave : piece.modulated) {
    constexpr double k_slow = 16.0; // rad; below it Gauss quadrature is cheaper and more accurate than the closed form
    if (std::abs(wave.frequency) * (b - a) > k_slow) {
      PieceJet before, after;
      add_modulated(wave, a, true, before);
      add_modulated(wave, b, true, after);
      sum += (after.integral - before.integral) / (b - a);
      continue;
    }
    // A term τⁿ is integrated as finely as n half-waves over the piece.
    const double turn = std::abs(wave.frequency) + (b > 0.0 ? wave.power / b : 0.0);
    sum += gauss_mean(a, b, turn, [&](double tau) {
      PieceJet jet;
      add_modulated(wave, tau, false, jet);
      return jet.value;
    });
  }
  return sum;
}

bool is_finite(const Signal::Piece& piece) {
  double sum = piece.start;
  for (const double c : piece.c) sum += c;
  for (const Signal::Harmonic& h : piece.harmonics) sum += h.amplitude + h.frequency + h.phase;
  for (const Signal::Modulated& m : piece.modulated) sum += m.amplitude + m.frequency + m.phase;
  return std::isfinite(sum);
}

void check(const std::vector<Signal::Piece>& pieces) {
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (!is_finite(pieces[k])) throw std::invalid_argument("a piece of a signal holds a number that is not finite");
    if (k > 0 && !(pieces[k].start > pieces[k - 1].start)) throw std::invalid_argument("pieces of a signal must start at ascending times");
    for (const Signal::Harmonic& h : pieces[k].harmonics)
      if (h.frequency == 0.0) throw std::invalid_argument("a harmonic of frequency zero");
  }
}

} // namespace

Signal::Signal(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
  check(pieces_);
  for (Piece& piece : pieces_) {
    piece.is_level = piece.c[1] == 0.0 && piece.c[2] == 0.0 && piece.c[3] == 0.0;
    piece.is_usual = piece.is_level && piece.modulated.empty() && piece.harmonics.size() < k_block;
    for (Harmonic& h : piece.harmonics) {
      const portable::SinCos phase = portable::sin_cos(h.phase);
      h.cos_phase = phase.cos;
      h.sin_phase = phase.sin;
      h.integral_scale = h.amplitude / h.frequency;
      h.double_integral_scale = h.integral_scale / h.frequency;
    }
    for (Modulated& m : piece.modulated) {
      const portable::SinCos phase = portable::sin_cos(m.phase);
      m.cos_phase = phase.cos;
      m.sin_phase = phase.sin;
    }
  }
  accumulate_integrals();
  if (!is_constant())
    for (const Piece& piece : pieces_) breakpoints_.push_back(piece.start);
  value_at_zero_ = value(0.0);
}

Signal Signal::constant(double value) { return Signal({Piece{0.0, {value, 0.0, 0.0, 0.0}, {}, {}}}); }

// Computes the integrals at the starts of the pieces, forwards and backwards from the piece that contains t = 0. Pieces long before t = 0
// therefore do not reduce the accuracy of those after it.
void Signal::accumulate_integrals() {
  if (pieces_.empty()) return;
  const Piece* at_zero = piece_at(0.0);
  const std::size_t first = at_zero ? static_cast<std::size_t>(at_zero - pieces_.data()) : 0;
  if (at_zero) {
    Piece& p = pieces_[first];
    const PieceJet jet = evaluate(p, -p.start);
    p.integral = -jet.integral;
    p.double_integral = -jet.double_integral + p.integral * p.start;
  }
  for (std::size_t k = first; k > 0; --k) {
    const Piece& next = pieces_[k];
    Piece& p = pieces_[k - 1];
    const double length = next.start - p.start;
    const PieceJet jet = evaluate(p, length);
    p.integral = next.integral - jet.integral;
    p.double_integral = next.double_integral - p.integral * length - jet.double_integral;
  }
  for (std::size_t k = first + 1; k < pieces_.size(); ++k) {
    const Piece& last = pieces_[k - 1];
    const double length = pieces_[k].start - last.start;
    const PieceJet jet = evaluate(last, length);
    pieces_[k].integral = last.integral + jet.integral;
    pieces_[k].double_integral = last.double_integral + last.integral * length + jet.double_integral;
  }
}

const Signal::Piece* Signal::piece_at(double t) const {
  constexpr std::ptrdiff_t k_few = 8; // number of pieces searched linearly from the last piece, where runs spend most of their time
  const Piece *const begin = pieces_.data(), *piece = begin + pieces_.size();
  if (piece <= begin + k_few) {
    while (piece != begin)
      if (!(t < (--piece)->start)) return piece;
    return nullptr;
  }
  const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), t, [](double time, const Piece& p) { return time < p.start; });
  return after == pieces_.begin() ? nullptr : &*(after - 1);
}

double Signal::value(double t) const {
  const Piece* piece = piece_at(t);
  return piece ? evaluate(*piece, t - piece->start, false).value : 0.0;
}

namespace {

// Returns Signal::drive() at level acceleration, for a piece with Piece::is_usual. Bit-identical to evaluate(), but without the derivatives
// that drive() does not need.
[[gnu::noinline]] SignalJet driven_by_acceleration(const Signal::Piece& piece, double tau) {
  double value = piece.c[0], integral = tau * piece.c[0], double_integral = tau * tau * (piece.c[0] / 2);
  for (const Signal::Harmonic& h : piece.harmonics) {
    const double x = h.frequency * tau;
    const auto [s, c] = portable::sin_cos(0.5 * x);
    const double sine = 2.0 * s * c, versine = 2.0 * s * s, cosine = 1.0 - versine;
    value += h.amplitude * (h.cos_phase * cosine - h.sin_phase * sine);
    integral += h.integral_scale * (h.cos_phase * sine - h.sin_phase * versine);
    double bracket = h.cos_phase * versine;
    if (h.sin_phase != 0.0) bracket += h.sin_phase * sine_minus_argument(x);
    double_integral += h.double_integral_scale * bracket;
  }
  return {double_integral + (piece.double_integral + piece.integral * tau), integral + piece.integral, value};
}

// Returns drive() for any piece; `piece` null: before the first one. `value_at_zero` is f(0).
[[gnu::noinline]] SignalJet driven_by(const Signal::Piece* piece, const std::vector<Signal::Piece>& pieces, double value_at_zero, double t,
                                      DriveLevel level) {
  PieceJet jet;
  if (piece) {
    const double tau = t - piece->start;
    jet = evaluate(*piece, tau, level != DriveLevel::position);
    jet.double_integral += piece->double_integral + piece->integral * tau;
    jet.integral += piece->integral;
  } else if (!pieces.empty() && pieces.front().start < 0.0) {
    const Signal::Piece& p = pieces.front();
    jet.integral = p.integral;
    jet.double_integral = p.double_integral + p.integral * (t - p.start);
  }
  switch (level) {
  case DriveLevel::position: return {jet.value - value_at_zero, jet.rate, jet.second_rate};
  case DriveLevel::velocity: return {jet.integral, jet.value, jet.rate};
  case DriveLevel::acceleration: break;
  }
  return {jet.double_integral, jet.integral, jet.value};
}

} // namespace

// Evaluates the most frequent case inline, because a drive is constant during most of a run.
SignalJet Signal::drive(double t, DriveLevel level) const {
  const Piece* const piece = piece_at(t);
  if (level != DriveLevel::acceleration || !piece || !piece->is_usual) return driven_by(piece, pieces_, value_at_zero_, t, level);
  const double tau = t - piece->start;
  if (!piece->harmonics.empty()) return driven_by_acceleration(*piece, tau);
  const double value = piece->c[0];
  return {tau * tau * (value / 2) + (piece->double_integral + piece->integral * tau), tau * value + piece->integral, value};
}

double Signal::mean(double from, double to) const {
  const Piece* piece = piece_at(from);
  const Piece* const end = pieces_.data() + pieces_.size();
  double sum = 0.0;
  for (double a = from; a < to;) {
    const Piece* const next = piece ? piece + 1 : pieces_.data();
    const double b = next == end ? to : std::min(to, next->start);
    if (piece) sum += (b - a) / (to - from) * mean_of(*piece, a - piece->start, b - piece->start);
    a = b;
    piece = next;
  }
  return sum;
}

double Signal::fastest_at(double t) const {
  constexpr int k_tame_power = 3;   // cubics need no step limit: every method integrates them accurately
  constexpr double k_slight = 1e-2; // relative to the piece: smaller terms change no extreme significantly, and error control resolves them
  double fastest = 0.0;
  const Piece* piece = piece_at(t);
  if (!piece) return fastest;
  for (const Harmonic& harmonic : piece->harmonics)
    if (harmonic.amplitude != 0.0) fastest = std::max(fastest, std::abs(harmonic.frequency));
  const bool is_last = piece == &pieces_.back();
  for (const Modulated& m : piece->modulated) {
    if (m.amplitude == 0.0) continue;
    fastest = std::max(fastest, std::abs(m.frequency));
    if (m.power <= k_tame_power || is_last) continue;
    const double length = (piece + 1)->start - piece->start;
    if (std::abs(m.amplitude) * power(length, m.power) <= k_slight * magnitude(*piece, length)) continue;
    fastest = std::max(fastest, m.power * std::numbers::pi / length);
  }
  return fastest;
}

bool Signal::is_constant() const {
  if (pieces_.empty()) return true;
  const Piece& p = pieces_.front();
  return pieces_.size() == 1 && p.start <= 0.0 && p.harmonics.empty() && p.modulated.empty() && p.c[1] == 0.0 && p.c[2] == 0.0 &&
         p.c[3] == 0.0;
}

namespace {

constexpr double k_least_jump = 1e-12; // relative to the terms of both sides: a smaller difference is rounding, not a jump

// Values on both sides of a breakpoint. `scale` is the size of the terms, to which rounding errors are proportional.
struct Sides {
  double before = 0.0, after = 0.0, scale = 0.0;
  [[nodiscard]] bool differ() const { return std::abs(after - before) > k_least_jump * scale; }
};

// Returns a bound of |f′| on the piece up to τ, as the sum of the absolute terms.
double rate_magnitude(const Signal::Piece& piece, double tau) {
  double sum = std::abs(piece.c[1]) + tau * (2.0 * std::abs(piece.c[2]) + tau * 3.0 * std::abs(piece.c[3]));
  for (const Signal::Harmonic& h : piece.harmonics) sum += std::abs(h.amplitude * h.frequency);
  for (const Signal::Modulated& m : piece.modulated) {
    const double slope = m.power > 0 ? m.power * power(tau, m.power - 1) : 0.0;
    sum += std::abs(m.amplitude) * (slope + std::abs(m.frequency) * power(tau, m.power));
  }
  return sum;
}

// Returns a bound of the error in the value at the end of a piece that is due to rounded start and end times; delays cause these.
double time_rounding(const Signal::Piece& piece, double end, double length) {
  return 4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(piece.start), std::abs(end)) * rate_magnitude(piece, length);
}

Sides values_at(const std::vector<Signal::Piece>& pieces, std::size_t k) {
  const Signal::Piece& right = pieces.at(k);
  Sides sides{0.0, evaluate(right, 0.0).value, magnitude(right, 0.0)};
  if (k == 0) return sides;
  const Signal::Piece& left = pieces[k - 1];
  const double length = right.start - left.start;
  sides.before = evaluate(left, length).value;
  sides.scale = std::max(sides.scale, magnitude(left, length)) + time_rounding(left, right.start, length) / k_least_jump;
  return sides;
}

// Returns a bound of the error in the slope between two samples that is due to rounding of their values and times.
double slope_rounding(const Signal::Piece& piece, double length) {
  const double value = magnitude(piece, length) + std::abs(piece.start) * rate_magnitude(piece, length);
  return 16.0 * std::numeric_limits<double>::epsilon() * value / length;
}

Sides rates_at(const std::vector<Signal::Piece>& pieces, std::size_t k) {
  const Signal::Piece& right = pieces.at(k);
  Sides sides{0.0, evaluate(right, 0.0).rate, rate_magnitude(right, 0.0)};
  if (k + 1 < pieces.size()) sides.scale += slope_rounding(right, pieces[k + 1].start - right.start) / k_least_jump;
  if (k == 0) return sides;
  const Signal::Piece& left = pieces[k - 1];
  const double length = right.start - left.start;
  sides.before = evaluate(left, length).rate;
  sides.scale = std::max(sides.scale, rate_magnitude(left, length) + slope_rounding(left, length) / k_least_jump);
  return sides;
}

} // namespace

bool Signal::jumps_at(std::size_t k) const { return values_at(pieces_, k).differ(); }

bool Signal::rate_jumps_at(std::size_t k) const { return rates_at(pieces_, k).differ(); }

std::optional<Signal::Jump> Signal::first_jump(DriveLevel level, double from, double end) const {
  if (level == DriveLevel::acceleration) return std::nullopt;
  for (std::size_t k = 0; k < breakpoints_.size(); ++k) {
    const double t = breakpoints_[k];
    if (t <= from || t >= end) continue;
    if (const Sides values = values_at(pieces_, k); values.differ()) return Jump{t, values.before, values.after, false};
    if (level != DriveLevel::position) continue;
    if (const Sides rates = rates_at(pieces_, k); rates.differ()) return Jump{t, rates.before, rates.after, true};
  }
  return std::nullopt;
}

// `text`: the doubt, with the share of the largest value in percent.
void Signal::doubt_cut(double t, double value, double noise, const char* text) {
  constexpr double k_much = 0.2; // of the largest value; what rattles before and after an event stays below
  double peak = std::abs(value);
  for (const Piece& piece : pieces_) peak = std::max(peak, std::abs(piece.c[0]));
  if (!(std::abs(value) > k_much * peak) || peak <= noise) return;
  char words[160];
  std::snprintf(words, sizeof words, text, 100.0 * std::abs(value) / peak);
  add_doubt(t, words);
}

void Signal::doubt_cut_end(double noise) {
  if (pieces_.size() > 1)
    doubt_cut(pieces_.back().start, values_at(pieces_, pieces_.size() - 1).before, noise,
              "the record ends at %.0f %% of its largest value, within an event: give what came after, or end the run there");
}

void Signal::doubt_cut_begin(double noise) {
  if (pieces_.size() > 1)
    doubt_cut(pieces_.front().start, pieces_.front().c[0], noise,
              "the record begins at %.0f %% of its largest value, within an event: give what came before");
}

} // namespace steplap
