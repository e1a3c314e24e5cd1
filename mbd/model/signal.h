// Signals: scalar functions of time with exact derivatives and integrals.
//
// A signal is a sequence of pieces. On each piece it is a cubic polynomial plus a sum of harmonics, so that its derivatives and both
// integrals are closed forms. A body driven by an acceleration therefore has position, velocity and acceleration that agree up to rounding.
// Products of signals contain powers of time multiplied by harmonics, which have closed-form integrals, too (signal_algebra.h). Before the
// first piece a signal is 0; integrals start at t = 0.
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

/// Derivative of a coordinate that a signal prescribes.
enum class DriveLevel { position, velocity, acceleration };

/// A function of time t in s. It never changes, so that several threads may evaluate it. The unit of its values follows from its use.
class Signal {
public:
  /// amplitude · cos(frequency τ + phase), with τ = t − start of the piece; frequency ≠ 0.
  struct Harmonic {
    double amplitude = 0.0;             ///< in the signal's unit
    double frequency = 1.0;             ///< rad/s
    double phase = 0.0;                 ///< rad
    double cos_phase = 1.0;             ///< computed by Signal
    double sin_phase = 0.0;             ///< computed by Signal
    double integral_scale = 0.0;        ///< amplitude/frequency, computed by Signal
    double double_integral_scale = 0.0; ///< amplitude/frequency², computed by Signal
  };
  /// amplitude · τ^power · cos(frequency τ + phase), as it occurs in products. Frequency 0 gives a polynomial term of degree above 3.
  struct Modulated {
    int power = 0;          ///< exponent of τ
    double amplitude = 0.0; ///< in the signal's unit over s^power
    double frequency = 0.0; ///< rad/s
    double phase = 0.0;     ///< rad
    double cos_phase = 1.0; ///< computed by Signal
    double sin_phase = 0.0; ///< computed by Signal
  };
  /// c0 + c1 τ + c2 τ² + c3 τ³ + Σ harmonics + Σ modulated, for start ≤ t < start of the next piece.
  struct Piece {
    double start = 0.0;                 ///< s
    double c[4] = {0.0, 0.0, 0.0, 0.0}; ///< polynomial coefficients
    std::vector<Harmonic> harmonics;    ///< Σ harmonics
    std::vector<Modulated> modulated;   ///< Σ modulated harmonics
    bool is_level = true;               ///< c1 = c2 = c3 = 0; computed by Signal
    bool is_usual = true;               ///< a constant and at most seven harmonics, which a faster path evaluates; computed by Signal
    double integral = 0.0;              ///< ∫ from 0 to start; computed by Signal
    double double_integral = 0.0;       ///< ∬ from 0 to start; computed by Signal
  };

  Signal() = default; ///< identically zero
  /// Creates a signal from pieces in ascending order of `start`. Throws std::invalid_argument if they are not, or if a number is not
  /// finite.
  explicit Signal(std::vector<Piece> pieces);
  /// Returns the signal that is `value` from t = 0 on.
  static Signal constant(double value);

  /// Returns f(t).
  [[nodiscard]] double value(double t) const;
  /// Returns the prescribed coordinate relative to its value at t = 0, its rate and its acceleration, at time t. The coordinate is f(t) −
  /// f(0) for level position, ∫f for velocity, and ∬f, from rest at t = 0, for acceleration.
  [[nodiscard]] SignalJet drive(double t, DriveLevel level) const;
  /// Returns the mean value of f over [from, to], from < to.
  [[nodiscard]] double mean(double from, double to) const;
  /// Returns the times at which the signal or one of its derivatives may jump, in ascending order: the starts of the pieces, none for a
  /// constant.
  [[nodiscard]] const std::vector<double>& breakpoints() const { return breakpoints_; }
  /// Returns true if the signal has the same value at all times.
  [[nodiscard]] bool is_constant() const;
  /// Returns the pieces in ascending order of time.
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  /// Returns the highest angular frequency in the piece that contains t, rad/s; 0 if there is none. A power τ^p with p > 3 counts as p
  /// half-waves over its piece.
  [[nodiscard]] double fastest_at(double t) const;
  /// Returns true if f jumps at breakpoint k by more than rounding.
  [[nodiscard]] bool jumps_at(std::size_t k) const;
  /// Returns true if f′ jumps at breakpoint k by more than rounding.
  [[nodiscard]] bool rate_jumps_at(std::size_t k) const;
  /// Jump of the position or the velocity of a coordinate driven at `level`, which no motion can follow.
  struct Jump {
    double t = 0.0, before = 0.0, after = 0.0; ///< s; values before and after in the signal's unit, or per s
    bool is_of_rate = false;                   ///< before and after are f′ rather than f
  };
  /// Returns the first jump with from < t < end.
  [[nodiscard]] std::optional<Jump> first_jump(DriveLevel level, double from, double end) const;

  /// A reason why measured data behind the signal may not be what acted.
  struct Doubt {
    double t = 0.0;   ///< s; runs that end before this time are not affected
    std::string text; ///< sentence without a full stop
  };
  /// Returns all doubts.
  [[nodiscard]] const std::vector<Doubt>& doubts() const { return doubts_; }
  /// Adds a doubt.
  void add_doubt(double t, std::string text) { doubts_.push_back({t, std::move(text)}); }
  /// Adds a doubt if the last value before the final jump to zero is a large part of the largest one: the record ends within an event. A
  /// largest value up to `noise` is none.
  void doubt_cut_end(double noise = 0.0);
  /// Adds a doubt if the first value, which comes after zero, is such a part.
  void doubt_cut_begin(double noise);

private:
  [[nodiscard]] const Piece* piece_at(double t) const;
  void doubt_cut(double t, double value, double noise, const char* text);
  void accumulate_integrals();
  std::vector<Piece> pieces_;
  std::vector<double> breakpoints_;
  std::vector<Doubt> doubts_;
  double value_at_zero_ = 0.0;
};

/// Common members of all signals in a model file. Kinds derive from it.
struct SignalDefinition {
  virtual ~SignalDefinition() = default;
  std::string name; ///< unique among signals
  Location where;   ///< location in the model file
};

/// Returns a new default-constructed T as a Base. Kinds refer to their entries by base class.
template <class Base, class T> std::shared_ptr<Base> create_object() { return std::make_shared<T>(); }
/// Returns a copy of `object`, which must be a T.
template <class Base, class T> std::shared_ptr<Base> copy_object(const Base& object) {
  return std::make_shared<T>(static_cast<const T&>(object));
}

/// One kind of signal. Kinds that combine other signals refer to them by name in fields of types signal and signals.
struct SignalKind {
  std::string name;                                        ///< name in model files, such as "haversine"
  std::string doc;                                         ///< a few sentences, with the formula
  FieldTable fields;                                       ///< fields of its struct
  std::shared_ptr<SignalDefinition> (*create)() = nullptr; ///< returns a new definition with default values; set by holds()
  std::shared_ptr<SignalDefinition> (*copy)(const SignalDefinition& definition) = nullptr; ///< returns a copy; set by holds()
  /// Makes the signal. Throws ModelError (at definition.where) if the values do not define a signal.
  Signal (*build)(const SignalDefinition& definition) = nullptr;
  /// Makes a signal from others, in place of `build`. `parts` are the referenced signals, in the order of the fields.
  Signal (*combine)(const SignalDefinition& definition, const std::vector<const Signal*>& parts) = nullptr;

  /// Declares T as the struct of the definitions of this kind.
  template <class T> void holds() {
    create = create_object<SignalDefinition, T>;
    copy = copy_object<SignalDefinition, T>;
  }
};

/// Returns the kinds constant, haversine, half_sine, triangle, trapezoid, rectangle, sine, harmonics, chirp, sum, product, scaled, road,
/// random, sea (mbd/io adds `record`, elements/catalog.cpp `shunting`).
[[nodiscard]] const std::vector<const SignalKind*>& signal_kinds();

} // namespace steplap
