#include "mbd/model/signal_algebra.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace steplap {

namespace {

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
constexpr double k_same_time = 16.0 * k_epsilon;     // relative; times closer than this are merged, for example "start + duration" and the
                                                     // same time given as a number
constexpr double k_same_frequency = 4.0 * k_epsilon; // relative to the larger; closer frequencies are merged

// A piece as polynomial of any degree plus waves A τⁿ cos(ωτ + φ) with ω > 0.
struct Terms {
  std::array<double, k_most_power + 1> polynomial{};
  std::vector<Signal::Modulated> waves;

  void add_power(int power, double value) {
    if (value == 0.0) return;
    check_power(power);
    polynomial[power] += value;
  }
  void add_wave(int power, double amplitude, double frequency, double phase) {
    if (amplitude == 0.0) return;
    check_power(power);
    if (frequency == 0.0) return add_power(power, amplitude * portable::cos(phase));
    const double sign = frequency < 0.0 ? -1.0 : 1.0;
    waves.push_back({power, amplitude, sign * frequency, sign * phase});
    if (waves.size() > k_most_terms) throw std::invalid_argument("has pieces of more than " + std::to_string(k_most_terms) + " harmonics");
  }
  void add(const Terms& other, double factor) {
    for (int n = 0; n <= k_most_power; ++n) add_power(n, factor * other.polynomial[n]);
    for (const Signal::Modulated& w : other.waves) add_wave(w.power, factor * w.amplitude, w.frequency, w.phase);
  }

private:
  static void check_power(int power) {
    if (power > k_most_power)
      throw std::invalid_argument("has pieces with powers of time above the " + std::to_string(k_most_power) + "th");
  }
};

// Expands (τ + d)ⁿ: calls take(k, coefficient) for each power τᵏ.
template <class Take> void expand(int n, double d, const Take& take) {
  double coefficient = 1.0; // binomial(n, k) d^(n−k), from k = n downwards
  for (int k = n; k >= 0; --k) {
    take(k, coefficient);
    coefficient *= d * k / (n - k + 1);
  }
}

// Returns the piece as a function of the time since `start`, which must not be before the start of the piece.
Terms terms_of(const Signal::Piece& piece, double start) {
  double d = start - piece.start;
  if (std::abs(d) <= k_same_time * std::abs(start)) d = 0.0;
  Terms terms;
  const auto add_power = [&](int n, double value) {
    if (value != 0.0) expand(n, d, [&](int k, double c) { terms.add_power(k, c * value); });
  };
  for (int n = 0; n < 4; ++n) add_power(n, piece.c[n]);
  for (const Signal::Harmonic& h : piece.harmonics) terms.add_wave(0, h.amplitude, h.frequency, h.phase + h.frequency * d);
  for (const Signal::Modulated& m : piece.modulated) {
    if (m.frequency == 0.0) add_power(m.power, m.amplitude * portable::cos(m.phase));
    else expand(m.power, d, [&](int k, double c) { terms.add_wave(k, c * m.amplitude, m.frequency, m.phase + m.frequency * d); });
  }
  return terms;
}

Signal::Piece piece_of(const Terms& terms, double start) {
  Signal::Piece piece;
  piece.start = start;
  std::copy_n(terms.polynomial.begin(), 4, piece.c);
  for (int n = 4; n <= k_most_power; ++n)
    if (terms.polynomial[n] != 0.0) piece.modulated.push_back({n, terms.polynomial[n], 0.0, 0.0});
  for (const Signal::Modulated& w : terms.waves)
    if (w.power == 0) piece.harmonics.push_back({w.amplitude, w.frequency, w.phase});
    else piece.modulated.push_back(w);
  return piece;
}

void multiply_waves(const Signal::Modulated& a, const Signal::Modulated& b, Terms& result) {
  const int power = a.power + b.power;
  const double half = 0.5 * a.amplitude * b.amplitude;
  double difference = a.frequency - b.frequency;
  if (std::abs(difference) <= k_same_frequency * std::max(a.frequency, b.frequency)) difference = 0.0;
  result.add_wave(power, half, a.frequency + b.frequency, a.phase + b.phase);
  result.add_wave(power, half, difference, a.phase - b.phase);
}

Terms product(const Terms& a, const Terms& b) {
  Terms result;
  for (int i = 0; i <= k_most_power; ++i) {
    for (int j = 0; j <= k_most_power; ++j) result.add_power(i + j, a.polynomial[i] * b.polynomial[j]);
    for (const Signal::Modulated& w : b.waves) result.add_wave(w.power + i, a.polynomial[i] * w.amplitude, w.frequency, w.phase);
    for (const Signal::Modulated& w : a.waves) result.add_wave(w.power + i, b.polynomial[i] * w.amplitude, w.frequency, w.phase);
  }
  for (const Signal::Modulated& v : a.waves)
    for (const Signal::Modulated& w : b.waves) multiply_waves(v, w, result);
  return result;
}

// Returns the starts of all pieces in ascending order, without times that differ only by rounding. Constant signals begin at t = 0.
std::vector<double> starts_of(const std::vector<const Signal*>& parts) {
  std::vector<double> times;
  for (const Signal* part : parts) {
    if (part->is_constant()) times.push_back(0.0);
    else
      for (const Signal::Piece& piece : part->pieces()) times.push_back(piece.start);
  }
  std::sort(times.begin(), times.end());
  const auto is_same = [](double a, double b) { return b - a <= k_same_time * std::abs(b); };
  times.erase(std::unique(times.begin(), times.end(), is_same), times.end());
  return times;
}

// Returns the terms of one signal at ascending times, by advancing through its pieces.
class Cursor {
public:
  explicit Cursor(const Signal& signal) : signal_(signal) {}

  Terms at(double t) {
    const std::vector<Signal::Piece>& pieces = signal_.pieces();
    if (pieces.empty()) return {};
    if (signal_.is_constant()) return t < 0.0 ? Terms{} : terms_of(pieces.front(), pieces.front().start);
    while (next_ < pieces.size() && pieces[next_].start - t <= k_same_time * std::abs(t)) ++next_;
    return next_ > 0 ? terms_of(pieces[next_ - 1], t) : Terms{};
  }

private:
  const Signal& signal_;
  std::size_t next_ = 0;
};

// Builds a signal piece by piece. For each interval between common breakpoints, combine(k, terms, result) is called for each signal k in
// turn.
template <class Combine> Signal combined(const std::vector<const Signal*>& parts, const Combine& combine) {
  std::vector<Cursor> cursors;
  for (const Signal* part : parts) cursors.emplace_back(*part);
  std::vector<Signal::Piece> pieces;
  for (const double start : starts_of(parts)) {
    Terms whole;
    for (std::size_t k = 0; k < parts.size(); ++k) combine(k, cursors[k].at(start), whole);
    pieces.push_back(piece_of(whole, start));
  }
  return Signal(std::move(pieces));
}

} // namespace

Signal sum_of(const std::vector<const Signal*>& parts, const std::vector<double>& factors) {
  return combined(parts, [&](std::size_t k, const Terms& part, Terms& whole) { whole.add(part, factors[k]); });
}

Signal product_of(const std::vector<const Signal*>& parts) {
  return combined(parts, [](std::size_t k, Terms part, Terms& whole) { whole = k == 0 ? std::move(part) : product(whole, part); });
}

Signal delayed(const Signal& signal, double delay, double factor) {
  std::vector<Signal::Piece> pieces = signal.pieces();
  for (Signal::Piece& piece : pieces) {
    piece.start += delay;
    for (double& c : piece.c) c *= factor;
    for (Signal::Harmonic& h : piece.harmonics) h.amplitude *= factor;
    for (Signal::Modulated& m : piece.modulated) m.amplitude *= factor;
  }
  return Signal(std::move(pieces));
}

} // namespace steplap
