// Normal laws of unilateral contacts for LawGroup. Modes: open, pressed, released (closed, force zero).
//
// A spring whose damper holds back is left behind by what it pressed, δ = −c δ̇/k deep: released is what is certain to be that
// deep, by the law and as measured. With less, down to no damping at all, the contact opens where its force ends, and
// whatever rounding and the joints' residuals leave of the gap there is no time in which it is released.
#pragma once

#include "mbd/base/portable_math.h"
#include "mbd/system/law_group.h"

#include <algorithm>

namespace steplap {

/// f = max(0, −kδ − cδ̇) while δ < 0: the damper never pulls.
struct KelvinVoigtContact {
  static constexpr int k_watches = 2;
  static constexpr bool k_is_contact = true;
  double k = 0.0, c = 0.0, offset = 0.0;

  template <class S> [[nodiscard]] S raw(const S& value, const S& rate) const { return S(-k) * (value - S(offset)) - S(c) * rate; }
  template <class S> [[nodiscard]] S force(const S& value, const S& rate, UnitMode mode) const {
    return mode == k_contact_pressed ? raw(value, rate) : S(0);
  }
  template <class S> [[nodiscard]] S elastic_force(const S& value, UnitMode mode) const {
    return mode == k_contact_open ? S(0.0) : -k * (value - offset);
  }
  [[nodiscard]] double energy(double value) const {
    const double closed = std::min(0.0, value - offset);
    return 0.5 * k * closed * closed;
  }
  [[nodiscard]] UnitMode mode_at(double value, double rate) const {
    if (value - offset >= 0.0) return k_contact_open;
    return raw(value, rate) >= 0.0 ? k_contact_pressed : k_contact_released;
  }
  template <class S> void watch(const S& value, const S& rate, UnitMode mode, S* watch, S* watch_rate) const {
    const S gap = value - offset;
    if (mode == k_contact_open) {
      watch[0] = gap;
      watch_rate[0] = rate;
      watch[1] = 1.0;
    } else if (mode == k_contact_pressed) {
      watch[0] = raw(value, rate);
      watch_rate[0] = std::numeric_limits<double>::quiet_NaN();
      watch[1] = 1.0;
    } else {
      watch[0] = -gap;
      watch_rate[0] = -rate;
      watch[1] = -raw(value, rate);
    }
  }
  // What closes presses: where it does, rounding leaves a gap of either sign, and a force of −kδ − cδ̇ of either, if nothing damps.
  // `rounding`: of the value.
  [[nodiscard]] UnitMode next_mode(UnitMode mode, int slot, double value, double rate, double rounding) const {
    const bool is_closed = is_surely_closed(value, rounding);
    if (mode == k_contact_open) {
      if (rate <= 0.0 || raw(value, rate) >= 0.0) return k_contact_pressed;
      return is_closed ? k_contact_released : k_contact_open;
    }
    if (mode == k_contact_pressed) return is_closed && c * rate > k * rounding ? k_contact_released : k_contact_open;
    return slot == 0 ? k_contact_open : k_contact_pressed;
  }
  [[nodiscard]] bool is_surely_positive(UnitMode mode, int slot, double value, double rounding) const {
    return mode == k_contact_released && slot == 0 && is_surely_closed(value, rounding);
  }
  [[nodiscard]] bool is_surely_closed(double value, double rounding) const { return offset - value > rounding; }
  static EventKind transition(UnitMode from, UnitMode to) {
    if (to == k_contact_open) return EventKind::opens;
    if (from == k_contact_open) return EventKind::closes;
    return to == k_contact_released ? EventKind::force_reaches_zero : EventKind::force_returns;
  }
};

/// f = −kδ − cδ̇ while δ < 0, as the paper writes it: the damper may pull just before opening.
struct LiteralContact {
  static constexpr int k_watches = 1;
  static constexpr bool k_is_contact = true;
  double k = 0.0, c = 0.0, offset = 0.0;

  template <class S> [[nodiscard]] S force(const S& value, const S& rate, UnitMode mode) const {
    return mode == k_contact_pressed ? S(-k) * (value - S(offset)) - S(c) * rate : S(0);
  }
  template <class S> [[nodiscard]] S elastic_force(const S& value, UnitMode mode) const {
    return mode == k_contact_open ? S(0.0) : -k * (value - offset);
  }
  [[nodiscard]] double energy(double value) const {
    const double closed = std::min(0.0, value - offset);
    return 0.5 * k * closed * closed;
  }
  [[nodiscard]] UnitMode mode_at(double value, double) const { return value - offset < 0.0 ? k_contact_pressed : k_contact_open; }
  template <class S> void watch(const S& value, const S& rate, UnitMode mode, S* watch, S* watch_rate) const {
    const double sign = mode == k_contact_open ? 1.0 : -1.0;
    watch[0] = sign * (value - offset);
    watch_rate[0] = sign * rate;
  }
  [[nodiscard]] UnitMode next_mode(UnitMode mode, int, double, double, double) const {
    return mode == k_contact_open ? k_contact_pressed : k_contact_open;
  }
  static EventKind transition(UnitMode, UnitMode to) { return to == k_contact_open ? EventKind::opens : EventKind::closes; }
};

/// f = k|δ|ⁿ (1 − α δ̇), never below zero (K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440).
///
/// While the mode says pressed, k|δ|ⁿ goes on beyond δ = 0 with its sign changed, as a line does: stages of a step
/// that is too long may be thrown out of the contact, on either side of something round, and where they felt nothing
/// the step's error would be seen as zero.
struct HuntCrossleyContact {
  static constexpr int k_watches = 2;
  static constexpr bool k_is_contact = true;
  double k = 0.0, exponent = 1.5, alpha = 0.0, offset = 0.0;

  template <class S> [[nodiscard]] S force(const S& value, const S& rate, UnitMode mode) const {
    if (mode != k_contact_pressed) return S(0);
    return S(k) * power(S(offset) - value) * (S(1) - S(alpha) * rate);
  }
  [[nodiscard]] double elastic_force(double value, UnitMode mode) const { return mode == k_contact_open ? 0.0 : k * power(offset - value); }
  [[nodiscard]] double energy(double value) const {
    return value < offset ? k * portable::pow(offset - value, exponent + 1.0) / (exponent + 1.0) : 0.0;
  }
  [[nodiscard]] UnitMode mode_at(double value, double rate) const {
    if (value - offset >= 0.0) return k_contact_open;
    return alpha * rate <= 1.0 ? k_contact_pressed : k_contact_released;
  }
  void watch(double value, double rate, UnitMode mode, double* watch, double* watch_rate) const {
    const double sign = mode == k_contact_open ? 1.0 : -1.0;
    watch[0] = sign * (value - offset);
    watch_rate[0] = sign * rate;
    watch[1] = mode == k_contact_open ? 1.0 : (mode == k_contact_pressed ? 1.0 : -1.0) * (1.0 - alpha * rate);
  }
  [[nodiscard]] UnitMode next_mode(UnitMode mode, int slot, double, double rate, double) const {
    if (mode == k_contact_open) return alpha * rate <= 1.0 ? k_contact_pressed : k_contact_released;
    if (slot == 0) return k_contact_open;
    return mode == k_contact_pressed ? k_contact_released : k_contact_pressed;
  }
  static EventKind transition(UnitMode from, UnitMode to) { return KelvinVoigtContact::transition(from, to); }

private:
  template <class S> [[nodiscard]] S power(const S& depth) const {
    using portable::pow;
    if (exponent == 1.0) return depth;
    if (depth > S(0)) return pow(depth, exponent);
    return depth < S(0) ? -pow(-depth, exponent) : S(0);
  }
};

} // namespace steplap
