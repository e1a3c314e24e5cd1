// Signals: scalar functions of time, with their exact integrals and derivatives.
//
// Every signal is a sequence of pieces between breakpoints; a piece is a cubic polynomial plus a sum of
// harmonics, so value, derivatives and both integrals from t = 0 on are closed forms, and a body driven
// by an acceleration has position, velocity and acceleration that agree to rounding. Products bring powers of
// time times harmonics, whose integrals are closed forms as well (signal_algebra.h).
// Limits: before the first breakpoint a signal is 0; integrals start at t = 0.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/model/fields.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Value, first and second derivative of a function of time.
struct SignalJet {
  double value = 0.0;        ///< in the signal's unit
  double rate = 0.0;         ///< per s
  double acceleration = 0.0; ///< per s²
};

/// What a driven coordinate follows: the signal is its position, its velocity or its acceleration.
enum class DriveLevel { position, velocity, acceleration };

/// A function of time, constant once made: read by any number of threads. Times are in s, values in the unit that its user
/// gives it.
class Signal {
public:
  /// amplitude · cos(frequency τ + phase), τ from the start of the piece; frequency in rad/s, ≠ 0.
  struct Harmonic {
    double amplitude = 0.0;             ///< in the signal's unit
    double frequency = 1.0;             ///< rad/s
    double phase = 0.0;                 ///< rad
    double cos_phase = 1.0;             ///< filled by Signal
    double sin_phase = 0.0;             ///< filled by Signal
    double integral_scale = 0.0;        ///< amplitude/frequency (filled by Signal)
    double double_integral_scale = 0.0; ///< that over the frequency once more (filled by Signal)
  };
  /// amplitude · τ^power · cos(frequency τ + phase), as products have them; a frequency of 0 makes a higher
  /// power of a polynomial.
  struct Modulated {
    int power = 0;          ///< of τ in s
    double amplitude = 0.0; ///< in the signal's unit over s^power
    double frequency = 0.0; ///< rad/s
    double phase = 0.0;     ///< rad
    double cos_phase = 1.0; ///< filled by Signal
    double sin_phase = 0.0; ///< filled by Signal
  };
  /// c0 + c1 τ + c2 τ² + c3 τ³ + Σ harmonics + Σ modulated, for start ≤ t < start of the next piece.
  struct Piece {
    double start = 0.0;                 ///< s
    double c[4] = {0.0, 0.0, 0.0, 0.0}; ///< of powers of τ in s
    std::vector<Harmonic> harmonics;    ///< any number
    std::vector<Modulated> modulated;   ///< any number
    bool is_level = true;               ///< c1 = c2 = c3 = 0 (filled by Signal)
    bool is_usual = true;               ///< so, with few harmonics and nothing modulated: as most drives are (filled by Signal)
    double integral = 0.0;              ///< ∫ from 0 to start (filled by Signal)
    double double_integral = 0.0;       ///< ∬ from 0 to start (filled by Signal)
  };

  Signal() = default; ///< identically zero
  /// Pieces in ascending order of start, every number finite. Throws std::invalid_argument otherwise.
  explicit Signal(std::vector<Piece> pieces);
  /// The same value from t = 0 on.
  static Signal constant(double value);

  /// At t, s.
  [[nodiscard]] double value(double t) const;
  /// The driven coordinate's increment since t = 0, its rate and its acceleration at t, the signal
  /// being read at `level`: position f(t) − f(0), velocity ∫f, acceleration ∬f (from rest at t = 0).
  [[nodiscard]] SignalJet drive(double t, DriveLevel level) const;
  /// Of its values between two times, from < to: their integral over the time between.
  [[nodiscard]] double mean(double from, double to) const;
  /// Times at which the signal or one of its derivatives may jump, ascending: the starts of the
  /// pieces (none for a constant).
  [[nodiscard]] const std::vector<double>& breakpoints() const { return breakpoints_; }
  /// Has it the same value throughout?
  [[nodiscard]] bool is_constant() const;
  /// Ascending in time.
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  /// Angular frequency of the fastest of its harmonics in the piece that holds t, rad/s; 0 if it has none. A
  /// power above the third counts as so many half waves over its piece.
  [[nodiscard]] double fastest_at(double t) const;
  /// True where the value itself jumps at breakpoint k by more than rounding.
  [[nodiscard]] bool jumps_at(std::size_t k) const;
  /// True where its rate does.
  [[nodiscard]] bool rate_jumps_at(std::size_t k) const;
  /// Where a coordinate that follows the signal, read at `level`, cannot: its place or its velocity would jump.
  struct Jump {
    double t = 0.0, before = 0.0, after = 0.0; ///< s; in the signal's unit, or that per s
    bool is_of_rate = false;                   ///< before, after: rates of the signal, else values
  };
  /// The first with from < t < end.
  [[nodiscard]] std::optional<Jump> first_jump(DriveLevel level, double from, double end) const;

private:
  [[nodiscard]] const Piece* piece_at(double t) const;
  void accumulate_integrals();
  std::vector<Piece> pieces_;
  std::vector<double> breakpoints_;
  double value_at_zero_ = 0.0;
};

/// What any kind of signal has in a model file; kinds derive from it.
struct SignalDefinition {
  virtual ~SignalDefinition() = default;
  std::string name; ///< unique among signals
  Location where;   ///< in the model's file
};

/// For the kinds of things that a model holds by pointers to their base.
template <class Base, class T> std::shared_ptr<Base> make_held() { return std::make_shared<T>(); }
/// A copy of an object that is a T.
template <class Base, class T> std::shared_ptr<Base> copy_held(const Base& object) {
  return std::make_shared<T>(static_cast<const T&>(object));
}

/// Kinds that are made of other signals name them in fields of the types signal and signals.
struct SignalKind {
  std::string name;                                        ///< as written in a model file: "haversine"
  std::string doc;                                         ///< a few sentences: its formula
  FieldTable fields;                                       ///< of the struct that its definitions are
  std::shared_ptr<SignalDefinition> (*create)() = nullptr; ///< a new definition with the kind's defaults; set by holds()
  std::shared_ptr<SignalDefinition> (*copy)(const SignalDefinition& definition) = nullptr; ///< set by holds()
  /// Throws ModelError (at definition.where) for values that make no signal.
  Signal (*build)(const SignalDefinition& definition) = nullptr;
  /// Instead of `build`, of kinds made of others: `parts` in the order of their fields.
  Signal (*combine)(const SignalDefinition& definition, const std::vector<const Signal*>& parts) = nullptr;

  /// Its signals are described by a T.
  template <class T> void holds() {
    create = make_held<SignalDefinition, T>;
    copy = copy_held<SignalDefinition, T>;
  }
};

/// constant, haversine, half_sine, triangle, trapezoid, rectangle, harmonics, chirp, sum, product, scaled, road, random, sea
/// (mbd/io adds `record`).
[[nodiscard]] const std::vector<const SignalKind*>& signal_kinds();

} // namespace steplap
