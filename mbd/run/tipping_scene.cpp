#include "mbd/run/tipping_scene.h"

#include "mbd/base/decompositions.h"
#include "mbd/base/portable_math.h"
#include "mbd/system/row_gradient.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_rank = 1e-8;      // tolerance of the rank, relative to the largest gradient of the rows
constexpr double k_one_slope = 0.02; // largest deviation, rad, of the directions of feet on one plane

} // namespace

TippingScene::TippingScene(const LoadedModel& loaded, const State& state)
    : loaded_(loaded), system_(*loaded.system), state_(state), statics_(system_) {
  std::fill(state_.v.begin(), state_.v.end(), 0.0);
  start_drives(system_, state_);
  statics_.evaluate(state_);
  feet_ = feet_of(loaded, state_);
  find_loads();
  find_stays();
  find_components();
}

// Computes for each body the force, and the couple about its centre of gravity, of all elements except contacts, without gravity.
void TippingScene::find_loads() {
  Evaluation e = statics_.evaluation();
  std::vector<BodyForce> force(system_.bodies.size() + static_cast<std::size_t>(system_.links.size()));
  e.force = e.link_force = force.data();
  std::vector<PairJacobian> parts;
  for (const auto& group : system_.groups) {
    parts.clear();
    group->add_jacobian(e, parts);
    const bool is_contact = std::any_of(parts.begin(), parts.end(), [](const PairJacobian& j) { return j.contact >= 0; });
    if (!is_contact) {
      group->add_forces(e);
      springs_.insert(springs_.end(), parts.begin(), parts.end());
    }
  }
  for (int i = 0; i < system_.links.size(); ++i) {
    const Link& link = system_.links[i];
    const int slot = system_.links.slot(i);
    add_link_force(force[slot], statics_.motion()[slot], statics_.motion()[link.b], force[link.a], force[link.b]);
  }
  load_.assign(force.begin(), force.begin() + system_.body_count());
  std::vector<std::string> touching;
  for (const Foot& foot : feet_) touching.push_back(foot.element);
  hanging_ = hanging_loads(loaded_, state_, touching, load_);
  for (std::size_t i = 0; i < load_.size(); ++i) {
    load_[i].fx += hanging_.correction[i].fx;
    load_[i].fy += hanging_.correction[i].fy;
    load_[i].m += hanging_.correction[i].m;
  }
}

// Finds taut inextensible ropes that carry no hanging load. They act as constraints against lengthening.
void TippingScene::find_stays() {
  for (const auto& [rope, friction] : one_sided_rows(system_)) {
    if (rope->left(statics_.motion().data()) > OneSidedRow::k_too_long * rope->length) continue;
    const auto& by = hanging_.by;
    const std::string& name = system_.element_names[system_.frictions[friction].element];
    if (std::find(by.begin(), by.end(), name) == by.end()) stays_.push_back(rope);
  }
}

// Finds sets of bodies connected by constraint rows, without the ground and hanging loads.
void TippingScene::find_components() {
  component_.resize(system_.bodies.size());
  for (int i = 0; i < system_.body_count(); ++i) component_[i] = i;
  for (const RowSpec& row : system_.rows) {
    if (row.a == k_ground || row.b == k_ground || is_hung(row.a) || is_hung(row.b) || component_[row.a] == component_[row.b]) continue;
    const int from = component_[row.a], to = component_[row.b];
    std::replace(component_.begin(), component_.end(), from, to);
  }
  for (int i = 1; i < system_.body_count(); ++i) {
    if (is_hung(i)) continue;
    const auto known = std::find(components_.begin(), components_.end(), component_[i]);
    if (known == components_.end()) components_.push_back(component_[i]);
  }
}

Eigen::Matrix<double, 6, 1> TippingScene::gradient(const RowSpec& row) const {
  return Eigen::Map<const Eigen::Matrix<double, 6, 1>>(gradient_of(evaluate_row<false>(row, statics_.motion().data())).j);
}

// Returns true if the joints within the component permit only its motions as a rigid body.
bool TippingScene::is_rigid(int component) const {
  std::vector<int> place(system_.bodies.size(), -1);
  int bodies = 0;
  for (int i = 1; i < system_.body_count(); ++i)
    if (component_[i] == component) place[i] = bodies++;
  if (bodies == 1) return true;
  MatX rows = MatX::Zero(static_cast<Eigen::Index>(system_.rows.size()), 3 * bodies);
  for (std::size_t r = 0; r < system_.rows.size(); ++r) {
    const RowSpec& row = system_.rows[r];
    if (place[row.a] < 0 || place[row.b] < 0) continue;
    const auto j = gradient(row);
    rows.block<1, 3>(static_cast<Eigen::Index>(r), 3 * place[row.a]) = j.head<3>().transpose();
    rows.block<1, 3>(static_cast<Eigen::Index>(r), 3 * place[row.b]) = j.tail<3>().transpose();
  }
  return PivotedQr(rows, k_rank).rank() == 3 * bodies - 3;
}

void TippingScene::add_component(int component, TippingPart& part) const {
  for (int i = 1; i < system_.body_count(); ++i)
    if (component_[i] == component) part[i] = 1;
}

// Returns the normal of the force on the part at a foot between the part and a body outside it; zero for other feet.
Vec2 TippingScene::contact_normal_on(const TippingPart& part, const Foot& foot) {
  if (part[foot.a] == part[foot.b]) return Vec2::Zero();
  return part[foot.a] ? foot.normal : Vec2(-foot.normal);
}

// Returns the component together with everything that stands on it.
std::optional<TippingPart> TippingScene::part_on(int component, std::string* why) const {
  const auto none = [why](const char* reason) -> std::optional<TippingPart> {
    if (why) *why = reason;
    return std::nullopt;
  };
  TippingPart part(system_.bodies.size(), 0);
  if (!is_rigid(component))
    return none("its joints let parts of it move against each other, and what forces or servos hold is not taken as rigid");
  add_component(component, part);
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (const Foot& foot : feet_) {
      const Vec2 push = contact_normal_on(part, foot);
      if (!(push.dot(system_.gravity) > 0.0)) continue; // a foot that supports the part is permitted
      const int above = part[foot.a] ? foot.b : foot.a;
      if (above == k_ground || !is_rigid(component_[above])) return none("what stands on it has joints that can move");
      add_component(component_[above], part);
      is_changed = true;
    }
  }
  // Repeated until nothing changes, because bodies added to the part may stand on further ones.
  for (const Foot& foot : feet_) {
    const Vec2 push = contact_normal_on(part, foot);
    const int own = part[foot.a] ? foot.a : foot.b;
    if (push != Vec2::Zero() && push.dot(system_.gravity) < 0.0 && component_[own] != component) return std::nullopt;
  }
  const auto is_to_another = [&](int a, int b) {
    return part[a] != part[b] && a != k_ground && b != k_ground && !is_hung(a) && !is_hung(b);
  };
  for (const PairJacobian& j : springs_) // the force of a spring to a body outside the part changes when the part tips
    if (is_to_another(j.a, j.b) && !j.stiffness.isZero()) return none("a spring or a servo ties it to another part that can move");
  for (const OneSidedRow* stay : stays_) {
    bool is_tied = false;
    stay->for_parts([&](const RowSpec& row) { is_tied = is_tied || is_to_another(row.a, row.b); });
    if (is_tied) return none("a rope ties it to another part that can move");
  }
  return part;
}

// Returns the angle counter-clockwise from the horizontal.
std::optional<double> TippingScene::slope_below(const TippingPart& part) const {
  const Vec2 up = -system_.gravity.normalized();
  std::optional<double> slope;
  for (const Foot& foot : feet_) {
    const Vec2 n = contact_normal_on(part, foot);
    if (n == Vec2::Zero()) continue;
    const double own = portable::atan2(up.x() * n.y() - up.y() * n.x(), up.dot(n));
    if (slope && std::abs(own - *slope) > k_one_slope) return std::nullopt;
    slope = slope.value_or(own);
  }
  return slope;
}

void TippingScene::name_part(const TippingPart& part, Tipping& tipping) const {
  int count = 0;
  for (int i = 1; i < system_.body_count(); ++i) {
    if (!part[i]) continue;
    ++count;
    if (tipping.body == 0 || system_.bodies[i].mass > system_.bodies[tipping.body].mass) tipping.body = i;
  }
  for (const HangingLoad& hung : hanging_.loads)
    if (part[hung.carrier]) count += hung.bodies;
  tipping.others = count - 1;
}

} // namespace steplap
