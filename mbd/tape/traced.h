// A number type that records the operations made with it on a tape (tape.h).
//
// It is used in the templates of the equations of motion in place of double. Each object has its value, computed as for double, and the
// step of the tape that produces it. Numbers known at recording (masses, positions in the file) are constants, and so are results of
// constants only. A comparison that depends on anything else is decided for the present values, and its result becomes a condition of the
// tape; another branch is never taken unnoticed. The value is accessible only by value_of(), for evaluating results.
//
// A. Griewank, A. Walther, Evaluating Derivatives, 2nd ed., SIAM 2008, §4 (evaluation traces).
#pragma once

#include "mbd/base/portable_math.h"
#include "mbd/tape/tape.h"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace steplap {

/// Thrown if the evaluation cannot be recorded with the present values.
struct NotTraceable {};

/// State of the recording in one thread. The memory of steps and constants is reused by the next recording.
struct TapeWriter {
  /// Largest number of steps of one operation: itself, and a constant for each operand.
  static constexpr std::ptrdiff_t k_room = 3;

  TapeStep *step = nullptr, *last_with_room = nullptr;
  double *constant = nullptr, *first_constant = nullptr; ///< capacity as for steps
  std::int32_t count = 0;                                ///< number of steps
  std::vector<TapeStep> steps;
  std::vector<double> constants;
  std::vector<std::int32_t> outputs;
  const Tape* known = nullptr;
  std::size_t usual_outputs = 0;
  std::int32_t input_count = 0;

  /// Returns true if there is capacity for k_room steps.
  [[nodiscard]] bool has_room() const { return step <= last_with_room; }
  void make_room() {
    if (!has_room()) [[unlikely]]
      grow();
  }
  /// Precondition of the following functions: has_room().
  std::int32_t put(TapeOperation operation, std::int32_t a, std::int32_t b) {
    *step++ = {operation, a, b};
    return count++;
  }
  std::int32_t put_constant(double value) {
    if (value == 0.0) return put(TapeOperation::constant, std::signbit(value) ? k_minus_zero : k_zero, 0);
    if (std::abs(value) == 1.0) return put(TapeOperation::constant, value < 0.0 ? k_minus_one : k_one, 0);
    *constant = value;
    return put(TapeOperation::constant, static_cast<std::int32_t>(constant++ - first_constant), 0);
  }
  void grow();
  static inline constinit thread_local TapeWriter* now = nullptr;
};

/// A recorded number.
class TapeNumber {
public:
  TapeNumber() = default;
  TapeNumber(double constant) : value_(constant) {} // conversion of constants

  /// Starts recording in this thread. finish() ends it and moves the recorded tape to `tape`, or discards it if null. If `known` is given,
  /// the recording is compared with that tape: finish() stores only the constants and returns true if everything else is equal.
  static void start(const Tape* known = nullptr);
  static bool finish(Tape* tape);
  /// Returns the next input, with its present value.
  [[nodiscard]] static TapeNumber input(double value);
  /// Makes x the next output.
  static void output(const TapeNumber& x);
  /// Records a call of `function`, for operations that a tape does not have. The call gets its own address as first argument, then
  /// `arguments`. If all arguments are constants, so are the results; a function that depends on anything else must therefore have an
  /// argument that is not constant.
  static void call(TapeFunction function, std::span<const TapeNumber> arguments, std::span<TapeNumber> results);
  /// Makes the outputs recorded so far the usual ones (Tape::usual_outputs).
  static void end_usual_outputs() { TapeWriter::now->usual_outputs = TapeWriter::now->outputs.size(); }

  /// Returns true if the value does not depend on inputs.
  [[nodiscard]] bool is_constant() const { return step_ < 0; }
  friend double value_of(const TapeNumber& x) { return x.value_; }

  friend TapeNumber operator+(const TapeNumber& a, const TapeNumber& b) { return made(TapeOperation::add, a, b, a.value_ + b.value_); }
  friend TapeNumber operator-(const TapeNumber& a, const TapeNumber& b) { return made(TapeOperation::subtract, a, b, a.value_ - b.value_); }
  friend TapeNumber operator*(const TapeNumber& a, const TapeNumber& b) { return made(TapeOperation::multiply, a, b, a.value_ * b.value_); }
  friend TapeNumber operator/(const TapeNumber& a, const TapeNumber& b) { return made(TapeOperation::divide, a, b, a.value_ / b.value_); }
  friend TapeNumber operator-(const TapeNumber& a) { return made(TapeOperation::negate, a, a, -a.value_); }
  TapeNumber& operator+=(const TapeNumber& o) { return *this = *this + o; }
  TapeNumber& operator-=(const TapeNumber& o) { return *this = *this - o; }
  TapeNumber& operator*=(const TapeNumber& o) { return *this = *this * o; }

  friend bool operator<(const TapeNumber& a, const TapeNumber& b) { return decided(a, b); }
  friend bool operator>(const TapeNumber& a, const TapeNumber& b) { return decided(b, a); }

  friend TapeNumber sqrt(const TapeNumber& a) { return made(TapeOperation::square_root, a, a, std::sqrt(a.value_)); }
  friend TapeNumber abs(const TapeNumber& a) { return made(TapeOperation::absolute, a, a, std::abs(a.value_)); }
  /// Minimum and maximum with the conventions of std::min and std::max for equal numbers and NaN.
  friend TapeNumber least_of(const TapeNumber& a, const TapeNumber& b) {
    return made(TapeOperation::minimum, b, a, b.value_ < a.value_ ? b.value_ : a.value_);
  }
  friend TapeNumber greatest_of(const TapeNumber& a, const TapeNumber& b) {
    return made(TapeOperation::maximum, a, b, a.value_ < b.value_ ? b.value_ : a.value_);
  }
  friend void find_sin_cos(const TapeNumber& a, TapeNumber& sine, TapeNumber& cosine) {
    const portable::SinCos turn = portable::sin_cos(a.value_);
    sine = made(TapeOperation::sine, a, a, turn.sin);
    cosine = made(TapeOperation::cosine, a, a, turn.cos);
  }
  friend TapeNumber atan2(const TapeNumber& y, const TapeNumber& x) {
    const TapeNumber arguments[] = {y, x};
    TapeNumber angle;
    call([](const double* of, double* found) { *found = portable::atan2(of[1], of[2]); }, arguments, {&angle, 1});
    return angle;
  }

private:
  // Calls nothing except as the last statement, when memory must grow, so that the compiler saves no registers.
  static TapeNumber made(TapeOperation operation, const TapeNumber& a, const TapeNumber& b, double value) {
    TapeNumber x(value);
    if (a.is_constant() && b.is_constant()) return x;
    TapeWriter& to = *TapeWriter::now;
    if (!to.has_room()) [[unlikely]]
      return made_after_growing(operation, a, b, value);
    const std::int32_t first = a.is_constant() ? to.put_constant(a.value_) : a.step_;
    const std::int32_t second = &a == &b ? first : b.is_constant() ? to.put_constant(b.value_) : b.step_;
    x.step_ = to.put(operation, first, second);
    return x;
  }
  static TapeNumber made_after_growing(TapeOperation operation, const TapeNumber& a, const TapeNumber& b, double value);
  static bool decided(const TapeNumber& a, const TapeNumber& b);
  // Returns the step of the number; for a constant, the step that adds the constant to the tape. Precondition for a constant: has_room().
  [[nodiscard]] std::int32_t step() const { return step_ >= 0 ? step_ : TapeWriter::now->put_constant(value_); }

  double value_ = 0.0;
  std::int32_t step_ = -1; ///< −1: constant
};

/// Returns true if x is zero for all inputs; for a double, if it is zero. Skipping such terms does not change a sum that began with +0.
inline bool is_structural_zero(double x) { return x == 0.0; }
inline bool is_structural_zero(const TapeNumber& x) { return x.is_constant() && value_of(x) == 0.0; }

inline double least_of(double a, double b) { return b < a ? b : a; }
inline double greatest_of(double a, double b) { return a < b ? b : a; }
inline void find_sin_cos(double a, double& sine, double& cosine) {
  const portable::SinCos turn = portable::sin_cos(a);
  sine = turn.sin;
  cosine = turn.cos;
}

} // namespace steplap
