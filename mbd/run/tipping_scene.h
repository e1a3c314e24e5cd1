// Describes a pose for the analysis of tipping: rigid parts, feet, ropes, loads and hanging loads.
#pragma once

#include "mbd/rest/statics.h"
#include "mbd/run/tipping.h"
#include "mbd/run/tipping_feet.h"
#include "mbd/run/tipping_hung.h"
#include "mbd/system/one_sided_row.h"

#include <optional>
#include <vector>

namespace steplap {

using TippingPart = std::vector<char>; ///< per body: belongs to the part

/// Returns `r` turned counter-clockwise by a right angle.
[[nodiscard]] inline Vec2 quarter_turn(const Vec2& r) { return {-r.y(), r.x()}; }

/// Bodies, feet, springs and loads of a pose. Keeps references to the model.
class TippingScene {
public:
  static constexpr double k_still = 1e-6; ///< velocity of a foot, relative to the motion, below which it neither lifts nor sinks

  /// Analyses the pose of `state`. Keeps a reference to `loaded`.
  TippingScene(const LoadedModel& loaded, const State& state);

  /// Returns the system of the model.
  [[nodiscard]] const System& system() const { return system_; }
  /// Returns all touching contact points.
  [[nodiscard]] const std::vector<Foot>& feet() const { return feet_; }
  /// Returns the taut inextensible ropes that carry no hanging load. They act as constraints against lengthening.
  [[nodiscard]] const std::vector<const OneSidedRow*>& stays() const { return stays_; }
  /// Returns all freely hanging loads.
  [[nodiscard]] const std::vector<HangingLoad>& hung() const { return hanging_.loads; }
  /// Returns springs and similar elements, with the bodies that they connect.
  [[nodiscard]] const std::vector<PairJacobian>& springs() const { return springs_; }
  /// Returns the force on a body, about its centre of gravity, of everything except gravity, contacts and joints.
  [[nodiscard]] const BodyForce& load(int body) const { return load_[body]; }
  /// Returns the centre of gravity, ground axes, m.
  [[nodiscard]] Vec2 centre(int body) const { return {state_.q[3 * body], state_.q[3 * body + 1]}; }
  /// Returns true if the body belongs to a hanging load.
  [[nodiscard]] bool is_hung(int body) const { return hanging_.is_hung[body] != 0; }
  /// Returns the component of a body. A component is a set of bodies connected by constraint rows.
  [[nodiscard]] int component(int body) const { return component_[body]; }
  /// Returns the numbers of all components.
  [[nodiscard]] const std::vector<int>& components() const { return components_; }
  /// Returns true if the joints within the component permit only motions of it as a rigid body.
  [[nodiscard]] bool is_rigid(int component) const;
  /// Adds all bodies of the component to the part.
  void add_component(int component, TippingPart& part) const;
  /// Returns the component together with everything that stands on it. Returns nothing if some of these bodies can move or also stand on
  /// another body. `why` receives the reason, as a clause after "because", if the component cannot be judged as a part of another one
  /// either.
  [[nodiscard]] std::optional<TippingPart> part_on(int component, std::string* why = nullptr) const;
  /// Returns the normal of the force on the part at a foot between the part and a body outside it; zero for other feet.
  [[nodiscard]] static Vec2 contact_normal_on(const TippingPart& part, const Foot& foot);
  /// Returns the gradient of a row's coordinate with respect to the poses of its two bodies.
  [[nodiscard]] Eigen::Matrix<double, 6, 1> gradient(const RowSpec& row) const;
  /// Returns the slope of the plane on which all feet of the part stand, counter-clockwise from the horizontal, rad; nothing if there is no
  /// common plane.
  [[nodiscard]] std::optional<double> slope_below(const TippingPart& part) const;
  /// Sets the heaviest body of the part and the number of other bodies in `tipping`.
  void name_part(const TippingPart& part, Tipping& tipping) const;

private:
  void find_loads();
  void find_stays();
  void find_components();

  const LoadedModel& loaded_;
  const System& system_;
  State state_;
  Statics statics_;
  std::vector<BodyForce> load_;
  std::vector<PairJacobian> springs_;
  HangingLoads hanging_;
  std::vector<const OneSidedRow*> stays_;
  std::vector<Foot> feet_;
  std::vector<int> component_, components_;
};

/// Returns the common collapses of parts that stand on several others, if they occur before any of the parts tips alone. `found`: margins
/// of the single parts.
[[nodiscard]] std::vector<Tipping> tipping_of_blocks(const TippingScene& scene, const std::vector<Tipping>& found);

} // namespace steplap
