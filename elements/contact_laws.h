// Normal force laws of unilateral contacts, for LawGroup (mbd/system/law_group.h, which defines the interface of a law).
//
// With `value` the measured distance, the gap is δ = value − offset, m: δ > 0 open, δ < 0 closed. `rate` is δ̇, m/s, positive while the
// bodies separate. The force f, N, acts on body a along ∂δ/∂q; f > 0 is compression.
//
//   KelvinVoigtContact   f = max(0, −kδ − cδ̇)             default; the force never pulls
//   AdhesiveKelvinVoigtContact       f = −kδ − cδ̇                     as in the paper; f < 0 is possible just before opening
//   HuntCrossleyContact  f = max(0, k|δ|ⁿ (1 − αδ̇))       damping proportional to the elastic force
//
// each for δ < 0; f = 0 for δ ≥ 0. Every law dissipates (elastic_force − f) δ̇. Source: docs/explanation/theory.md, section 2.
//
// Modes: open (δ ≥ 0), pressed (δ < 0, f > 0), released (δ < 0, f = 0: the bodies separate faster than the damped spring recovers).
// Within a mode the force is smooth, also a little beyond the mode's limit, where the stages of a step may lie before the event is
// located. A max() in a formula is therefore not evaluated; the change from pressed to released or open replaces it.
//
// Each law has k_event_count event functions, the arguments `event_value` and `event_derivative` of event_value(), the latter NaN where no
// cheap formula exists. S is double, a dual number or Traced. `rounding` is the absolute rounding error of `value`, m
// (mbd/system/rounding.h).
#pragma once

#include "mbd/base/portable_math.h"
#include "mbd/system/law_group.h"

#include <algorithm>

namespace steplap {

/// f = max(0, −kδ − cδ̇) for δ < 0.
///
/// The force becomes zero while the penetration −δ = c δ̇/k is left. Mode `released` is entered only if this penetration, computed and
/// measured, exceeds the rounding of δ. Otherwise, and always for c = 0, pressed changes directly to open. The modes therefore depend
/// continuously on c as c → 0.
struct KelvinVoigtContact {
  static constexpr int k_event_count = 2;
  static constexpr bool k_is_contact = true;
  double k = 0.0, c = 0.0, offset = 0.0; ///< stiffness, N/m; damping, N s/m; offset of the gap, m

  /// Returns −kδ − cδ̇, N, the force without the max().
  template <class S> [[nodiscard]] S unclamped_force(const S& value, const S& rate) const {
    return S(-k) * (value - S(offset)) - S(c) * rate;
  }
  template <class S> [[nodiscard]] S force(const S& value, const S& rate, UnitMode mode) const {
    return mode == k_contact_pressed ? unclamped_force(value, rate) : S(0);
  }
  template <class S> [[nodiscard]] S elastic_force(const S& value, UnitMode mode) const {
    return mode == k_contact_open ? S(0.0) : -k * (value - offset);
  }
  [[nodiscard]] double energy(double value) const {
    const double closed = std::min(0.0, value - offset);
    return 0.5 * k * closed * closed;
  }
  [[nodiscard]] UnitMode initial_mode(double value, double rate) const {
    if (value - offset >= 0.0) return k_contact_open;
    return unclamped_force(value, rate) >= 0.0 ? k_contact_pressed : k_contact_released;
  }
  /// Event functions. open: δ. pressed: −kδ − cδ̇. released: −δ (zero when the contact opens) and kδ + cδ̇ (zero when the force returns).
  template <class S> void event_value(const S& value, const S& rate, UnitMode mode, S* event_value, S* event_derivative) const {
    const S gap = value - offset;
    if (mode == k_contact_open) {
      event_value[0] = gap;
      event_derivative[0] = rate;
      event_value[1] = 1.0;
    } else if (mode == k_contact_pressed) {
      event_value[0] = unclamped_force(value, rate);
      event_derivative[0] = std::numeric_limits<double>::quiet_NaN();
      event_value[1] = 1.0;
    } else {
      event_value[0] = -gap;
      event_derivative[0] = -rate;
      event_value[1] = -unclamped_force(value, rate);
    }
  }
  /// Returns the mode after event function `slot` has become negative. A closing contact is pressed if δ̇ ≤ 0, whatever the sign of −kδ −
  /// cδ̇: δ is zero up to rounding there, so for c = 0 the sign of the force is rounding, too.
  [[nodiscard]] UnitMode next_mode(UnitMode mode, int slot, double value, double rate, double rounding) const {
    const bool is_closed = penetrates_beyond_rounding(value, rounding);
    if (mode == k_contact_open) {
      if (rate <= 0.0 || unclamped_force(value, rate) >= 0.0) return k_contact_pressed;
      return is_closed ? k_contact_released : k_contact_open;
    }
    if (mode == k_contact_pressed) return is_closed && c * rate > k * rounding ? k_contact_released : k_contact_open;
    return slot == 0 ? k_contact_open : k_contact_pressed;
  }
  /// Returns true only for −δ of a contact that has just been released. Every other event function starts at zero up to rounding.
  [[nodiscard]] bool is_armed_at_entry(UnitMode mode, int slot, double value, double rounding) const {
    return mode == k_contact_released && slot == 0 && penetrates_beyond_rounding(value, rounding);
  }
  [[nodiscard]] bool penetrates_beyond_rounding(double value, double rounding) const { return offset - value > rounding; }
  static EventKind event_kind(UnitMode from, UnitMode to) {
    if (to == k_contact_open) return EventKind::opens;
    if (from == k_contact_open) return EventKind::closes;
    return to == k_contact_released ? EventKind::force_reaches_zero : EventKind::force_returns;
  }
};

/// f = −kδ − cδ̇ for δ < 0, the paper's law (2), (4). The damper may pull before the contact opens, so there is no mode `released`.
struct AdhesiveKelvinVoigtContact {
  static constexpr int k_event_count = 1;
  static constexpr bool k_is_contact = true;
  double k = 0.0, c = 0.0, offset = 0.0; ///< stiffness, N/m; damping, N s/m; offset of the gap, m

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
  [[nodiscard]] UnitMode initial_mode(double value, double) const { return value - offset < 0.0 ? k_contact_pressed : k_contact_open; }
  /// Event functions. open: δ. pressed: −δ.
  template <class S> void event_value(const S& value, const S& rate, UnitMode mode, S* event_value, S* event_derivative) const {
    const double sign = mode == k_contact_open ? 1.0 : -1.0;
    event_value[0] = sign * (value - offset);
    event_derivative[0] = sign * rate;
  }
  [[nodiscard]] UnitMode next_mode(UnitMode mode, int, double, double, double) const {
    return mode == k_contact_open ? k_contact_pressed : k_contact_open;
  }
  static EventKind event_kind(UnitMode, UnitMode to) { return to == k_contact_open ? EventKind::opens : EventKind::closes; }
};

/// f = max(0, k|δ|ⁿ (1 − αδ̇)) for δ < 0 (K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440).
///
/// In mode pressed |δ|ⁿ is continued to δ > 0 as the odd function −δⁿ. The stages of a step that is too long may leave the contact,
/// past either side of a round body. If they all had zero force there, the error estimate of the step would be zero, and the step
/// would be accepted.
struct HuntCrossleyContact {
  static constexpr int k_event_count = 2;
  static constexpr bool k_is_contact = true;
  double k = 0.0, exponent = 1.5, alpha = 0.0, offset = 0.0; ///< k in N/mⁿ; n; α in s/m; offset of the gap, m

  template <class S> [[nodiscard]] S force(const S& value, const S& rate, UnitMode mode) const {
    if (mode != k_contact_pressed) return S(0);
    return S(k) * power(S(offset) - value) * (S(1) - S(alpha) * rate);
  }
  [[nodiscard]] double elastic_force(double value, UnitMode mode) const { return mode == k_contact_open ? 0.0 : k * power(offset - value); }
  [[nodiscard]] double energy(double value) const {
    return value < offset ? k * portable::pow(offset - value, exponent + 1.0) / (exponent + 1.0) : 0.0;
  }
  [[nodiscard]] UnitMode initial_mode(double value, double rate) const {
    if (value - offset >= 0.0) return k_contact_open;
    return alpha * rate <= 1.0 ? k_contact_pressed : k_contact_released;
  }
  /// Event functions. open: δ. pressed: −δ and 1 − αδ̇. released: −δ and αδ̇ − 1.
  void event_value(double value, double rate, UnitMode mode, double* event_value, double* event_derivative) const {
    const double sign = mode == k_contact_open ? 1.0 : -1.0;
    event_value[0] = sign * (value - offset);
    event_derivative[0] = sign * rate;
    event_value[1] = mode == k_contact_open ? 1.0 : (mode == k_contact_pressed ? 1.0 : -1.0) * (1.0 - alpha * rate);
  }
  [[nodiscard]] UnitMode next_mode(UnitMode mode, int slot, double, double rate, double) const {
    if (mode == k_contact_open) return alpha * rate <= 1.0 ? k_contact_pressed : k_contact_released;
    if (slot == 0) return k_contact_open;
    return mode == k_contact_pressed ? k_contact_released : k_contact_pressed;
  }
  static EventKind event_kind(UnitMode from, UnitMode to) { return KelvinVoigtContact::event_kind(from, to); }

private:
  /// Returns depthⁿ, continued as an odd function.
  template <class S> [[nodiscard]] S power(const S& depth) const {
    using portable::pow;
    if (exponent == 1.0) return depth;
    if (depth > S(0)) return pow(depth, exponent);
    return depth < S(0) ? -pow(-depth, exponent) : S(0);
  }
};

} // namespace steplap
