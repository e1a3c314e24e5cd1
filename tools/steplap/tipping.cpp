#include "tools/steplap/tipping.h"

#include "mbd/algebra/decompositions.h"
#include "mbd/analysis/statics.h"
#include "mbd/base/shown_text.h"
#include "mbd/math/portable_math.h"
#include "tools/steplap/summary.h"
#include "tools/steplap/text_table.h"
#include "tools/steplap/tipping_feet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <ostream>

namespace steplap {

namespace {

constexpr double k_rank = 1e-8;     // of rows' gradients
constexpr double k_still = 1e-6;    // of the part's size: a foot that neither lifts nor sinks
constexpr double k_one_slope = 0.02; // rad: feet that stand on one plane
constexpr double k_pi = std::numbers::pi;

Vec2 quarter_turn(const Vec2& r) { return {-r.y(), r.x()}; }

class TippingSearch {
public:
  TippingSearch(const LoadedModel& loaded, const State& state)
      : loaded_(loaded), system_(*loaded.system), state_(state), statics_(system_) {
    std::fill(state_.v.begin(), state_.v.end(), 0.0);
    start_drives(system_, state_);
    statics_.evaluate(state_);
    find_loads();
    feet_ = feet_of(loaded, state_);
  }

  std::vector<Tipping> run() {
    std::vector<Tipping> found;
    if (!(system_.gravity.norm() > 0.0) || feet_.empty()) return found;
    find_components();
    for (std::size_t c = 0; c < components_.size(); ++c)
      if (const auto part = part_on(static_cast<int>(c)))
        if (const auto tipping = nearest(*part)) found.push_back(*tipping);
    return found;
  }

private:
  using Part = std::vector<char>; ///< per body

  // Of everything but gravity and contacts, per body: force and couple about its centre of gravity.
  void find_loads() {
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
  }

  // Bodies that rows hold together, the ground left out.
  void find_components() {
    component_.resize(system_.bodies.size());
    for (int i = 0; i < system_.body_count(); ++i) component_[i] = i;
    for (const RowSpec& row : system_.rows) {
      if (row.a == k_ground || row.b == k_ground || component_[row.a] == component_[row.b]) continue;
      const int from = component_[row.a], to = component_[row.b];
      std::replace(component_.begin(), component_.end(), from, to);
    }
    for (int i = 1; i < system_.body_count(); ++i) {
      const auto known = std::find(components_.begin(), components_.end(), component_[i]);
      if (known == components_.end()) components_.push_back(component_[i]);
    }
  }

  [[nodiscard]] Eigen::Matrix<double, 6, 1> gradient(const RowSpec& row) const {
    const MeasureValue<double> m = evaluate_row<false>(row, statics_.motion().data());
    Eigen::Matrix<double, 6, 1> j;
    j << m.direction.x, m.direction.y, cross(m.lever_a, m.direction) + m.couple, -m.direction.x, -m.direction.y,
        -(cross(m.lever_b, m.direction) + m.couple);
    return j;
  }

  // Joints between its bodies leave it no motion but those of a rigid body.
  [[nodiscard]] bool is_rigid(int component) const {
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

  void add_component(int component, Part& part) const {
    for (int i = 1; i < system_.body_count(); ++i)
      if (component_[i] == component) part[i] = 1;
  }

  // Of a foot between the part and something else: the normal of the force on the part; zero for others.
  static Vec2 push_on(const Part& part, const Foot& foot) {
    if (part[foot.a] == part[foot.b]) return Vec2::Zero();
    return part[foot.a] ? foot.normal : Vec2(-foot.normal);
  }

  // A component with all that stands on it.
  [[nodiscard]] std::optional<Part> part_on(int c) const {
    Part part(system_.bodies.size(), 0);
    if (!is_rigid(components_[c])) return std::nullopt;
    add_component(components_[c], part);
    for (bool is_changed = true; is_changed;) {
      is_changed = false;
      for (const Foot& foot : feet_) {
        const Vec2 push = push_on(part, foot);
        if (!(push.dot(system_.gravity) > 0.0)) continue; // it is carried there, not pressed down
        const int above = part[foot.a] ? foot.b : foot.a;
        if (above == k_ground || !is_rigid(component_[above])) return std::nullopt;
        add_component(component_[above], part);
        is_changed = true;
      }
    }
    // What was taken along may stand elsewhere, too.
    for (const Foot& foot : feet_) {
      const Vec2 push = push_on(part, foot);
      const int own = part[foot.a] ? foot.a : foot.b;
      if (push != Vec2::Zero() && push.dot(system_.gravity) < 0.0 && component_[own] != components_[c]) return std::nullopt;
    }
    for (const PairJacobian& j : springs_) // another body that moves would change its force
      if (part[j.a] != part[j.b] && j.a != k_ground && j.b != k_ground && !j.stiffness.isZero()) return std::nullopt;
    return part;
  }

  [[nodiscard]] Vec2 centre(int body) const { return {state_.q[3 * body], state_.q[3 * body + 1]}; }

  // Rigid motions are (velocity of the ground's origin as the part sees it, rate of turning).
  [[nodiscard]] static Vec2 velocity(const Vec3& twist, const Vec2& at) { return Vec2(twist.head<2>()) + twist.z() * quarter_turn(at); }
  [[nodiscard]] static Vec3 turn_about(const Vec2& point, double rate) {
    const Vec2 v = -rate * quarter_turn(point);
    return {v.x(), v.y(), rate};
  }
  [[nodiscard]] static Vec3 gap_row(const Vec2& at, const Vec2& normal) {
    return {normal.x(), normal.y(), normal.dot(quarter_turn(at))};
  }

  // Of joints and drives between the part and the rest: what they say of its rigid motion.
  [[nodiscard]] MatX outer_rows(const Part& part) const {
    std::vector<Vec3> found;
    for (const RowSpec& row : system_.rows) {
      if (part[row.a] == part[row.b]) continue;
      const auto j = gradient(row);
      const Vec3 own = part[row.a] ? Vec3(j.head<3>()) : Vec3(j.tail<3>());
      const Vec2 c = centre(part[row.a] ? row.a : row.b), force = own.head<2>();
      found.push_back({own.x(), own.y(), own.z() + force.dot(quarter_turn(c))});
    }
    MatX rows(static_cast<Eigen::Index>(found.size()), 3);
    for (std::size_t i = 0; i < found.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = found[i].transpose();
    return rows;
  }

  // About a foot, the sense that lifts another one; nothing if others would be pressed in.
  [[nodiscard]] std::optional<Vec3> motion_about(const Foot& pivot, const Vec2& normal, const MatX& rows, double rate) const {
    if (rows.rows() == 0) return turn_about(pivot.point, rate);
    const Vec3 row = rows.row(0).transpose();
    const Vec3 twist = row.cross(gap_row(pivot.point, normal));
    if (!(std::abs(twist.z()) > k_rank * row.norm())) return std::nullopt;
    return Vec3(twist * (rate / twist.z()));
  }

  [[nodiscard]] std::optional<Tipping> nearest(const Part& part) const {
    const MatX rows = outer_rows(part);
    if (PivotedQr(rows, k_rank).rank() > 1) return std::nullopt;
    std::optional<Tipping> best;
    for (const Foot& pivot : feet_) {
      const Vec2 normal = push_on(part, pivot);
      if (normal == Vec2::Zero()) continue;
      for (const double rate : {1.0, -1.0}) {
        const auto twist = motion_about(pivot, normal, rows, rate);
        if (!twist) continue;
        const Foot* const lifted = lifted_by(part, pivot, *twist);
        if (!lifted) continue;
        const std::optional<Tipping> tipping = judged(part, *twist);
        if (!tipping || (best && best->margin <= tipping->margin)) continue;
        best = tipping;
        best->about = pivot.name;
        best->lifts = lifted->name;
      }
    }
    if (best) name_part(part, *best);
    return best;
  }

  [[nodiscard]] const Foot* lifted_by(const Part& part, const Foot& pivot, const Vec3& twist) const {
    const Foot* lifted = nullptr;
    double most = 0.0, size = 0.0;
    for (const Foot& foot : feet_)
      if (push_on(part, foot) != Vec2::Zero()) size = std::max(size, (foot.point - pivot.point).norm());
    for (const Foot& foot : feet_) {
      const Vec2 normal = push_on(part, foot);
      if (normal == Vec2::Zero() || &foot == &pivot) continue;
      const double rate = normal.dot(velocity(twist, foot.point));
      if (rate < -k_still * size) return nullptr;
      if (rate <= k_still * size || rate <= most) continue;
      most = rate;
      lifted = &foot;
    }
    return lifted;
  }

  [[nodiscard]] std::optional<Tipping> judged(const Part& part, const Vec3& twist) const {
    double of_gravity = 0.0, of_turned = 0.0, of_loads = 0.0;
    for (int i = 1; i < system_.body_count(); ++i) {
      if (!part[i]) continue;
      const Vec2 v = velocity(twist, centre(i));
      of_gravity += system_.bodies[i].mass * system_.gravity.dot(v);
      of_turned += system_.bodies[i].mass * quarter_turn(system_.gravity).dot(v);
      of_loads += load_[i].fx * v.x() + load_[i].fy * v.y() + load_[i].m * twist.z();
    }
    const double size = portable::hypot(of_gravity, of_turned);
    if (!(size > std::abs(of_loads))) return std::nullopt; // no tilt changes it
    const double now = of_gravity + of_loads, middle = portable::atan2(of_turned, of_gravity);
    const double reach = portable::atan2(std::sqrt(size * size - of_loads * of_loads), -of_loads); // acos(-of_loads/size)
    double nearest = 2.0 * k_pi;
    for (const double root : {middle - reach, middle + reach}) {
      const double turned = std::remainder(root, 2.0 * k_pi);
      if (std::abs(turned) < std::abs(nearest)) nearest = turned;
    }
    if (!(std::abs(nearest) < 0.5 * k_pi)) return std::nullopt;
    Tipping tipping;
    tipping.margin = now > 0.0 ? -std::abs(nearest) : std::abs(nearest);
    tipping.is_clockwise = (nearest > 0.0) == (now <= 0.0); // gravity turned one way is the ground tilted the other way
    if (std::abs(of_turned) > k_rank * size) tipping.acceleration = std::abs(now / of_turned) * system_.gravity.norm();
    if (const auto slope = slope_below(part)) {
      tipping.slope = slope;
      tipping.slope_at_most = *slope - nearest;
    }
    return tipping;
  }

  // Counter-clockwise from the horizontal.
  [[nodiscard]] std::optional<double> slope_below(const Part& part) const {
    const Vec2 up = -system_.gravity.normalized();
    std::optional<double> slope;
    for (const Foot& foot : feet_) {
      const Vec2 n = push_on(part, foot);
      if (n == Vec2::Zero()) continue;
      const double own = portable::atan2(up.x() * n.y() - up.y() * n.x(), up.dot(n));
      if (slope && std::abs(own - *slope) > k_one_slope) return std::nullopt;
      slope = slope.value_or(own);
    }
    return slope;
  }

  void name_part(const Part& part, Tipping& tipping) const {
    int count = 0;
    for (int i = 1; i < system_.body_count(); ++i) {
      if (!part[i]) continue;
      ++count;
      if (tipping.body == 0 || system_.bodies[i].mass > system_.bodies[tipping.body].mass) tipping.body = i;
    }
    tipping.others = count - 1;
  }

  const LoadedModel& loaded_;
  const System& system_;
  State state_;
  Statics statics_;
  std::vector<BodyForce> load_;
  std::vector<PairJacobian> springs_;
  std::vector<Foot> feet_;
  std::vector<int> component_;  ///< per body
  std::vector<int> components_; ///< each once
};

std::string degrees(double angle) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g°", std::abs(angle) * 180.0 / k_pi);
  return text;
}

std::string part_name(const System& system, const Tipping& t) {
  const std::string name = system.bodies[t.body].name;
  return t.others == 0 ? name : name + " and " + counted(static_cast<std::size_t>(t.others), "other", "others");
}

} // namespace

std::vector<Tipping> tipping_of(const LoadedModel& loaded, const State& state) { return TippingSearch(loaded, state).run(); }

std::vector<std::string> tipping_over(const LoadedModel& loaded, const State& state) {
  std::vector<std::string> found;
  for (const Tipping& t : tipping_of(loaded, state)) {
    if (t.margin >= 0.0) continue;
    const std::string name = "'" + loaded.system->bodies[t.body].name + "'" +
                             (t.others == 0 ? "" : " with " + counted(static_cast<std::size_t>(t.others), "other", "others"));
    std::string text = "in the pose given " + name + " tips over '" + t.about + "', and '" + t.lifts + "' lifts: the line of its loads passes " +
                       degrees(t.margin) + " outside";
    if (t.slope && std::abs(*t.slope) > std::abs(*t.slope_at_most))
      text += "; it would stand on slopes of up to " + degrees(*t.slope_at_most) + ", this one has " + degrees(*t.slope);
    found.push_back(text);
  }
  return found;
}

void print_tipping(std::ostream& out, const LoadedModel& loaded, const State& state) {
  using Align = TextTable::Align;
  TextTable table({Align::left, Align::left, Align::left, Align::right, Align::left, Align::right});
  table.add_row({"what stands", "tips over", "lifts", "tilted by", "", "or accelerated by"});
  bool is_any = false;
  for (const Tipping& t : tipping_of(loaded, state)) {
    if (t.margin < 0.0) continue;
    is_any = true;
    table.add_row({part_name(*loaded.system, t), t.about, t.lifts, degrees(t.margin), t.is_clockwise ? "clockwise" : "counter-clockwise",
                   t.acceleration > 0.0 ? quantity_text(t.acceleration, "m/s^2", 1.0) : "-"});
  }
  if (is_any) out << "\nDistance from tipping over\n" << table;
}

} // namespace steplap
