#include "mbd/base/portable_math.h"
#include "mbd/run/tipping_mechanism.h"
#include "mbd/run/tipping_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace steplap {

namespace {

constexpr double k_most_friction = 2.0; // largest coefficient of dry friction that is considered possible
constexpr double k_same = 1e-6;         // tilts that differ by less are equal, rad

class BlockTipping {
public:
  explicit BlockTipping(const TippingScene& scene) : scene_(scene) {}

  std::vector<Tipping> run(const std::vector<Tipping>& found) const {
    std::vector<Tipping> together;
    for (const std::vector<int>& group : leaning_groups())
      if (const auto tipping = nearest_of_group(group); tipping && is_before(found, group, *tipping)) together.push_back(*tipping);
    return together;
  }

private:
  // Returns groups of components that stand on each other, in which at least one component cannot be judged alone.
  [[nodiscard]] std::vector<std::vector<int>> leaning_groups() const {
    std::vector<int> group(scene_.system().bodies.size());
    for (int i = 0; i < scene_.system().body_count(); ++i) group[i] = scene_.component(i);
    for (const Foot& foot : scene_.feet())
      if (foot.a != k_ground && foot.b != k_ground) {
        const int from = group[foot.a], to = group[foot.b];
        std::replace(group.begin(), group.end(), from, to);
      }
    std::vector<std::vector<int>> found;
    for (const int c : scene_.components()) {
      if (scene_.part_on(c) || std::any_of(found.begin(), found.end(), [&](const auto& g) { return group[g.front()] == group[c]; }))
        continue;
      std::vector<int> members;
      for (const int other : scene_.components())
        if (group[other] == group[c]) members.push_back(other);
      if (members.size() > 1) found.push_back(members);
    }
    return found;
  }
  // Rows of the blocks' constraints. A row is the gradient of a unit force `along` at `at` on body a, and the opposite force on b.
  struct BlockRows {
    std::vector<int> place; ///< per body: index of its block; −1: the body is fixed
    int count = 0;
    double length = 0.0; ///< length by which angles are scaled
    void add(VecX& row, int body, const Vec3& part, double sign) const {
      if (place[body] < 0) return;
      row.segment<3>(3 * place[body]) += sign * Vec3(part.x(), part.y(), part.z() / length);
    }
  };
  [[nodiscard]] VecX block_row(const BlockRows& blocks, int a, int b, const Vec2& at, const Vec2& along) const {
    VecX row = VecX::Zero(3 * blocks.count);
    for (const auto& [body, sign] : {std::pair{a, 1.0}, {b, -1.0}})
      if (blocks.place[body] >= 0) blocks.add(row, body, {along.x(), along.y(), along.dot(quarter_turn(at - scene_.centre(body)))}, sign);
    return row;
  }
  [[nodiscard]] VecX block_row(const BlockRows& blocks, const RowSpec& spec) const {
    VecX row = VecX::Zero(3 * blocks.count);
    const auto j = scene_.gradient(spec);
    blocks.add(row, spec.a, j.head<3>(), 1.0);
    blocks.add(row, spec.b, j.tail<3>(), 1.0);
    return row;
  }
  static MatX stacked(const std::vector<VecX>& rows, int columns) {
    MatX all(static_cast<Eigen::Index>(rows.size()), columns);
    for (std::size_t i = 0; i < rows.size(); ++i) all.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
    return all;
  }

  [[nodiscard]] std::optional<TippingPart> part_of(const std::vector<int>& group) const {
    TippingPart part(scene_.system().bodies.size(), 0);
    for (const int c : group) {
      if (!scene_.is_rigid(c)) return std::nullopt;
      scene_.add_component(c, part);
    }
    for (const PairJacobian& j : scene_.springs()) { // springs between two blocks, or between a block and another moving body
      const bool is_between = j.a != k_ground && j.b != k_ground && !scene_.is_hung(j.a) && !scene_.is_hung(j.b) &&
                              scene_.component(j.a) != scene_.component(j.b);
      if (is_between && (part[j.a] || part[j.b]) && !j.stiffness.isZero()) return std::nullopt;
    }
    const auto is_foreign = [&](int body) { return body != k_ground && !part[body]; };
    for (const OneSidedRow* stay : scene_.stays()) {
      bool is_ours = false, is_tied = false;
      stay->for_parts([&](const RowSpec& row) {
        is_ours = is_ours || part[row.a] || part[row.b];
        is_tied = is_tied || is_foreign(row.a) || is_foreign(row.b);
      });
      if (is_ours && is_tied) return std::nullopt;
    }
    return part;
  }

  [[nodiscard]] std::optional<Tipping> nearest_of_group(const std::vector<int>& group) const {
    const std::optional<TippingPart> part = part_of(group);
    if (!part) return std::nullopt;
    BlockRows rows;
    rows.place.assign(scene_.system().bodies.size(), -1);
    for (int i = 1; i < scene_.system().body_count(); ++i)
      if ((*part)[i]) rows.place[i] = rows.count++;
    std::vector<const Foot*> feet;
    for (const Foot& foot : scene_.feet())
      if ((*part)[foot.a] || (*part)[foot.b]) feet.push_back(&foot);
    for (const Foot* foot : feet) rows.length = std::max(rows.length, (foot->point - feet.front()->point).norm());
    if (!(rows.length > 0.0)) return std::nullopt;
    const Blocks blocks = blocks_of(*part, rows, feet);
    std::optional<Tipping> best;
    for (const double sign : {1.0, -1.0}) {
      const auto collapse = collapse_of(blocks, sign);
      if (!collapse || !is_held_by_friction(*collapse, feet)) continue;
      if (best && std::abs(best->margin) <= std::abs(collapse->turned)) continue;
      best = told(*part, rows, feet, blocks, *collapse);
    }
    return best;
  }

  // Returns constraints and loads of a group of blocks. The rows of friction come first, one for each foot.
  [[nodiscard]] Blocks blocks_of(const TippingPart& part, const BlockRows& rows, const std::vector<const Foot*>& feet) const {
    const int n = 3 * rows.count;
    std::vector<VecX> joints, gaps;
    for (const Foot* foot : feet) {
      joints.push_back(block_row(rows, foot->a, foot->b, foot->point, quarter_turn(foot->normal)));
      gaps.push_back(block_row(rows, foot->a, foot->b, foot->point, foot->normal));
    }
    for (const RowSpec& row : scene_.system().rows)
      if ((part[row.a] || part[row.b]) && !scene_.is_hung(row.a) && !scene_.is_hung(row.b)) joints.push_back(block_row(rows, row));
    for (const OneSidedRow* stay : scene_.stays()) {
      VecX row = VecX::Zero(n);
      stay->for_parts([&](const RowSpec& spec) { row -= block_row(rows, spec); });
      if (!row.isZero()) gaps.push_back(row);
    }
    Blocks blocks{stacked(joints, n), stacked(gaps, n), VecX::Zero(n), VecX::Zero(n), VecX::Zero(n)};
    for (int i = 1; i < scene_.system().body_count(); ++i) {
      if (!part[i]) continue;
      const auto weigh = [&](double mass, const Vec2& at) {
        const auto push = [&](VecX& sum, const Vec2& f) {
          rows.add(sum, i, {f.x(), f.y(), f.dot(quarter_turn(at - scene_.centre(i)))}, mass);
        };
        push(blocks.weight, scene_.system().gravity);
        push(blocks.turned, quarter_turn(scene_.system().gravity));
      };
      weigh(scene_.system().bodies[i].mass, scene_.centre(i));
      for (const HangingLoad& hung : scene_.hung())
        if (hung.carrier == i) weigh(hung.mass, hung.point);
      rows.add(blocks.loads, i, {scene_.load(i).fx, scene_.load(i).fy, scene_.load(i).m}, 1.0);
    }
    return blocks;
  }

  // Returns true if friction coefficients up to k_most_friction suffice for the balance. Otherwise the bodies separate by sliding, and no
  // result is given.
  [[nodiscard]] bool is_held_by_friction(const Collapse& collapse, const std::vector<const Foot*>& feet) const {
    std::map<std::string, std::pair<double, double>> of_contact; // normal and tangential force of each contact
    double most = 0.0;
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      auto& [normal, tangential] = of_contact[feet[i]->element];
      normal += collapse.gap_forces[at];
      tangential += collapse.joint_forces[at];
      most = std::max(most, normal);
    }
    return std::all_of(of_contact.begin(), of_contact.end(), [&](const auto& contact) {
      return std::abs(contact.second.second) <= k_most_friction * contact.second.first + TippingScene::k_still * most;
    });
  }

  [[nodiscard]] Tipping told(const TippingPart& part, const BlockRows& rows, const std::vector<const Foot*>& feet, const Blocks& blocks,
                             const Collapse& collapse) const {
    Tipping tipping;
    const VecX& motion = collapse.motion;
    tipping.margin = collapse.stands ? std::abs(collapse.turned) : -std::abs(collapse.turned);
    tipping.is_clockwise = (collapse.turned > 0.0) == collapse.stands;
    const double now = (blocks.weight + blocks.loads).dot(motion), of_turned = blocks.turned.dot(motion);
    if (of_turned != 0.0) tipping.acceleration = std::abs(now / of_turned) * scene_.system().gravity.norm();
    if (const auto slope = scene_.slope_below(part)) {
      tipping.slope = slope;
      tipping.slope_at_most = *slope - collapse.turned;
    }
    TippingPart moving(scene_.system().bodies.size(), 0);
    for (int i = 1; i < scene_.system().body_count(); ++i)
      moving[i] = rows.place[i] >= 0 && motion.segment<3>(3 * rows.place[i]).norm() > TippingScene::k_still;
    scene_.name_part(moving, tipping);
    double most = 0.0, least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const double rate = blocks.gaps.row(static_cast<Eigen::Index>(i)).dot(motion);
      const bool is_outer = moving[feet[i]->a] != moving[feet[i]->b];
      if (rate > most) most = rate, tipping.lifts = feet[i]->name;
      if (is_outer && rate < least) least = rate, tipping.about = feet[i]->name;
    }
    return tipping;
  }

  // Returns true if the group collapses at a smaller tilt than each of its bodies tips alone.
  [[nodiscard]] bool is_before(const std::vector<Tipping>& found, const std::vector<int>& group, const Tipping& tipping) const {
    return std::none_of(found.begin(), found.end(), [&](const Tipping& t) {
      const bool is_ours = std::find(group.begin(), group.end(), scene_.component(t.body)) != group.end();
      return is_ours && t.margin <= tipping.margin + k_same;
    });
  }

  const TippingScene& scene_;
};

} // namespace

std::vector<Tipping> tipping_of_blocks(const TippingScene& scene, const std::vector<Tipping>& found) {
  return BlockTipping(scene).run(found);
}

} // namespace steplap
