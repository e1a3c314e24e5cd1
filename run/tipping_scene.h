// What there is to tip over in a pose: bodies that joints hold together, feet, ropes, loads and what hangs.
#pragma once

#include "mbd/rest/statics.h"
#include "mbd/system/one_sided_row.h"
#include "run/tipping.h"
#include "run/tipping_feet.h"
#include "run/tipping_hung.h"

#include <optional>
#include <vector>

namespace steplap {

using TippingPart = std::vector<char>; ///< per body: does it belong?

/// `r` turned counter-clockwise by a right angle.
[[nodiscard]] inline Vec2 quarter_turn(const Vec2& r) { return {-r.y(), r.x()}; }

/// The pose that is looked at, as bodies, feet, springs and loads. Refers to the model that it was made of.
class TippingScene {
public:
  static constexpr double k_still = 1e-6; ///< of its size: what neither lifts nor sinks

  /// In the pose of `state`; refers to `loaded`.
  TippingScene(const LoadedModel& loaded, const State& state);

  /// The system of the model.
  [[nodiscard]] const System& system() const { return system_; }
  /// Of all contacts that touch.
  [[nodiscard]] const std::vector<Foot>& feet() const { return feet_; }
  /// Inextensible ropes that are taut and carry nothing that hangs: they let no motion by which they would be longer.
  [[nodiscard]] const std::vector<const OneSidedRow*>& stays() const { return stays_; }
  /// Of all loads that hang freely.
  [[nodiscard]] const std::vector<HungLoad>& hung() const { return hanging_.loads; }
  /// Of springs and the like, between which bodies.
  [[nodiscard]] const std::vector<PairJacobian>& springs() const { return springs_; }
  /// On a body, about its centre of gravity: of everything but gravity, contacts and joints.
  [[nodiscard]] const BodyForce& load(int body) const { return load_[body]; }
  /// Centre of gravity, ground axes, m.
  [[nodiscard]] Vec2 centre(int body) const { return {state_.q[3 * body], state_.q[3 * body + 1]}; }
  /// Does the body belong to a load that hangs?
  [[nodiscard]] bool is_hung(int body) const { return hanging_.is_hung[body] != 0; }
  /// Bodies that rows hold together are of one component: the number of any body's, and all numbers.
  [[nodiscard]] int component(int body) const { return component_[body]; }
  /// The number of each component once.
  [[nodiscard]] const std::vector<int>& components() const { return components_; }
  /// Joints between its bodies leave it no motion but those of a rigid body.
  [[nodiscard]] bool is_rigid(int component) const;
  /// Marks all bodies of the component.
  void add_component(int component, TippingPart& part) const;
  /// A component with all that stands on it; nothing where some of that moves, or stands elsewhere, too. `why`: the reason,
  /// following "because", where no other part can be judged for it.
  [[nodiscard]] std::optional<TippingPart> part_on(int component, std::string* why = nullptr) const;
  /// Of a foot between the part and something else: the normal of the force on the part; zero for others.
  [[nodiscard]] static Vec2 push_on(const TippingPart& part, const Foot& foot);
  /// What a row measures, by the poses of its bodies.
  [[nodiscard]] Eigen::Matrix<double, 6, 1> gradient(const RowSpec& row) const;
  /// Of the plane that all feet of the part stand on, counter-clockwise from the horizontal.
  [[nodiscard]] std::optional<double> slope_below(const TippingPart& part) const;
  /// Fills in the heaviest body of the part and how many tip with it.
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
  Hanging hanging_;
  std::vector<const OneSidedRow*> stays_;
  std::vector<Foot> feet_;
  std::vector<int> component_, components_;
};

/// What stands on several others, with all of them: where it comes down before any of them would by itself. `found`:
/// what these would do.
[[nodiscard]] std::vector<Tipping> tipping_of_blocks(const TippingScene& scene, const std::vector<Tipping>& found);

} // namespace steplap
