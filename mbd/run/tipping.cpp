#include "mbd/run/tipping.h"

#include "mbd/base/decompositions.h"
#include "mbd/base/portable_math.h"
#include "mbd/run/tipping_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace steplap {

namespace {

constexpr double k_rank = 1e-8; // tolerance of the rank, relative to the largest gradient of the rows
constexpr double k_pi = std::numbers::pi;

// Tipping of single parts. Everything that stands on a part moves with it.
class PartTipping {
public:
  explicit PartTipping(const TippingScene& scene) : scene_(scene) {}

  std::vector<Tipping> run() const {
    std::vector<Tipping> found;
    for (const int component : scene_.components())
      if (const auto part = scene_.part_on(component))
        if (const auto tipping = nearest(*part)) found.push_back(*tipping);
    return found;
  }

  std::vector<UnjudgedPart> unjudged() const {
    std::vector<UnjudgedPart> found;
    for (const int component : scene_.components()) {
      TippingPart own(scene_.system().bodies.size(), 0);
      scene_.add_component(component, own);
      if (!is_carried(own)) continue;
      UnjudgedPart one;
      const auto part = scene_.part_on(component, &one.why);
      if (part && is_led(*part)) one.why = "joints or drives keep it from turning over";
      if (one.why.empty()) continue;
      Tipping heaviest;
      scene_.name_part(own, heaviest);
      one.body = heaviest.body;
      found.push_back(one);
    }
    return found;
  }

private:
  // Returns true if the part stands on at least one foot.
  [[nodiscard]] bool is_carried(const TippingPart& part) const {
    const std::vector<Foot>& feet = scene_.feet();
    return std::any_of(feet.begin(), feet.end(),
                       [&](const Foot& foot) { return TippingScene::contact_normal_on(part, foot).dot(scene_.system().gravity) < 0.0; });
  }
  // Returns true if joints to bodies outside the part prevent rotation about every foot.
  [[nodiscard]] bool is_led(const TippingPart& part) const {
    const MatX rows = outer_rows(part);
    if (rows.rows() == 0) return false;
    if (PivotedQr(rows, k_rank).rank() > 1) return true;
    return std::none_of(scene_.feet().begin(), scene_.feet().end(), [&](const Foot& pivot) {
      const Vec2 normal = TippingScene::contact_normal_on(part, pivot);
      return normal != Vec2::Zero() && motion_about(pivot, normal, rows, 1.0).has_value();
    });
  }

  // Returns the velocity of a point `at` of a rigid motion. `twist`: velocity of the point at the ground's origin (2), angular velocity
  // (1).
  [[nodiscard]] static Vec2 velocity(const Vec3& twist, const Vec2& at) { return Vec2(twist.head<2>()) + twist.z() * quarter_turn(at); }
  [[nodiscard]] static Vec3 turn_about(const Vec2& point, double rate) {
    const Vec2 v = -rate * quarter_turn(point);
    return {v.x(), v.y(), rate};
  }
  [[nodiscard]] static Vec3 gap_row(const Vec2& at, const Vec2& normal) { return {normal.x(), normal.y(), normal.dot(quarter_turn(at))}; }

  // Returns the gradients, with respect to the part's rigid motion, of joints and drives between the part and other bodies.
  [[nodiscard]] MatX outer_rows(const TippingPart& part) const {
    std::vector<Vec3> found;
    for (const RowSpec& row : scene_.system().rows) {
      if (part[row.a] == part[row.b] || scene_.is_hung(row.a) || scene_.is_hung(row.b)) continue;
      const auto j = scene_.gradient(row);
      const Vec3 own = part[row.a] ? Vec3(j.head<3>()) : Vec3(j.tail<3>());
      const Vec2 c = scene_.centre(part[row.a] ? row.a : row.b), force = own.head<2>();
      found.push_back({own.x(), own.y(), own.z() + force.dot(quarter_turn(c))});
    }
    MatX rows(static_cast<Eigen::Index>(found.size()), 3);
    for (std::size_t i = 0; i < found.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = found[i].transpose();
    return rows;
  }

  // Returns the rigid motion (velocity of the origin, angular velocity `rate`) in which the part turns about a foot, or slides on it across
  // `normal` as far as joints to other bodies require; nothing if joints permit none.
  [[nodiscard]] std::optional<Vec3> motion_about(const Foot& pivot, const Vec2& normal, const MatX& rows, double rate) const {
    if (rows.rows() == 0) return turn_about(pivot.point, rate);
    const Vec3 row = rows.row(0).transpose();
    const Vec3 twist = row.cross(gap_row(pivot.point, normal));
    if (!(std::abs(twist.z()) > k_rank * row.norm())) return std::nullopt;
    return Vec3(twist * (rate / twist.z()));
  }

  [[nodiscard]] std::optional<Tipping> nearest(const TippingPart& part) const {
    const MatX rows = outer_rows(part);
    if (PivotedQr(rows, k_rank).rank() > 1) return std::nullopt;
    std::optional<Tipping> best;
    for (const Foot& pivot : scene_.feet()) {
      const Vec2 normal = TippingScene::contact_normal_on(part, pivot);
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
    if (best) scene_.name_part(part, *best);
    return best;
  }

  // Returns the rate at which a rigid motion of the part lengthens a rope, m/s.
  [[nodiscard]] double lengthening(const TippingPart& part, const OneSidedRow& rope, const Vec3& twist) const {
    double rate = 0.0;
    rope.for_parts([&](const RowSpec& row) {
      const auto j = scene_.gradient(row);
      for (const auto& [body, at] : {std::pair{row.a, 0}, {row.b, 3}}) {
        if (!part[body]) continue;
        const Vec2 v = velocity(twist, scene_.centre(body));
        rate += j[at] * v.x() + j[at + 1] * v.y() + j[at + 2] * twist.z();
      }
    });
    return rate;
  }

  [[nodiscard]] const Foot* lifted_by(const TippingPart& part, const Foot& pivot, const Vec3& twist) const {
    const Foot* lifted = nullptr;
    double most = 0.0, size = 0.0;
    for (const Foot& foot : scene_.feet())
      if (TippingScene::contact_normal_on(part, foot) != Vec2::Zero()) size = std::max(size, (foot.point - pivot.point).norm());
    for (const OneSidedRow* stay : scene_.stays())
      if (lengthening(part, *stay, twist) > TippingScene::k_still * size) return nullptr;
    for (const Foot& foot : scene_.feet()) {
      const Vec2 normal = TippingScene::contact_normal_on(part, foot);
      if (normal == Vec2::Zero() || &foot == &pivot) continue;
      const double rate = normal.dot(velocity(twist, foot.point));
      if (rate < -TippingScene::k_still * size) return nullptr;
      if (rate <= TippingScene::k_still * size || rate <= most) continue;
      most = rate;
      lifted = &foot;
    }
    return lifted;
  }

  [[nodiscard]] std::optional<Tipping> judged(const TippingPart& part, const Vec3& twist) const {
    double of_gravity = 0.0, of_turned = 0.0, of_loads = 0.0;
    const auto weigh = [&](double mass, const Vec2& v) {
      of_gravity += mass * scene_.system().gravity.dot(v);
      of_turned += mass * quarter_turn(scene_.system().gravity).dot(v);
    };
    for (const HangingLoad& hung : scene_.hung())
      if (part[hung.carrier]) weigh(hung.mass, velocity(twist, hung.point));
    for (int i = 1; i < scene_.system().body_count(); ++i) {
      if (!part[i]) continue;
      const Vec2 v = velocity(twist, scene_.centre(i));
      weigh(scene_.system().bodies[i].mass, v);
      of_loads += scene_.load(i).fx * v.x() + scene_.load(i).fy * v.y() + scene_.load(i).m * twist.z();
    }
    const double size = portable::hypot(of_gravity, of_turned);
    if (!(size > std::abs(of_loads))) return std::nullopt; // no tilt changes the sign of the power
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
    // Gravity turned in one sense corresponds to the ground tilted in the opposite sense.
    tipping.is_clockwise = (nearest > 0.0) == (now <= 0.0);
    if (std::abs(of_turned) > k_rank * size) tipping.acceleration = std::abs(now / of_turned) * scene_.system().gravity.norm();
    if (const auto slope = scene_.slope_below(part)) {
      tipping.slope = slope;
      tipping.slope_at_most = *slope - nearest;
    }
    return tipping;
  }

  const TippingScene& scene_;
};

} // namespace

std::vector<UnjudgedPart> not_judged_for_tipping(const LoadedModel& loaded, const State& state) {
  const TippingScene scene(loaded, state);
  if (!(scene.system().gravity.norm() > 0.0) || scene.feet().empty()) return {};
  return PartTipping(scene).unjudged();
}

std::vector<Tipping> tipping_of(const LoadedModel& loaded, const State& state) {
  const TippingScene scene(loaded, state);
  if (!(scene.system().gravity.norm() > 0.0) || scene.feet().empty()) return {};
  std::vector<Tipping> found = PartTipping(scene).run();
  for (Tipping& tipping : tipping_of_blocks(scene, found)) found.push_back(std::move(tipping));
  return found;
}

} // namespace steplap
