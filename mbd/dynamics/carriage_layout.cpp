#include "mbd/dynamics/carriage_layout.h"

#include "mbd/math/portable_math.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace steplap {

namespace {

Vec2 turned(double c, double s, const Vec2& p) { return {c * p.x() - s * p.y(), s * p.x() + c * p.y()}; }

// A prismatic joint: across its axis, and the angle; neither moves with time.
bool is_guide(const System& system, const RowBlock& block) {
  if (block.count != 2) return false;
  const RowSpec &across = system.rows[block.first], &angle = system.rows[block.first + 1];
  return across.kind == MeasureKind::axis && angle.kind == MeasureKind::angle && !across.drive && !angle.drive &&
         across.a == angle.a && across.b == angle.b && std::abs(across.direction.norm() - 1.0) < 1e-12;
}

class Finder {
public:
  Finder(const System& system, const State& state, const Layout& layout)
      : system_(system), state_(state), layout_(layout), held_(layout.clusters.size(), 0), is_carrier_(layout.clusters.size(), 0),
        is_long_(clusters_on_long_rows(system, layout)) {}

  std::unique_ptr<Carriages> find(const std::vector<char>& is_block_merged, const std::vector<char>& is_friction_merged,
                                  JointCoordinates& found) {
    count_holds(is_block_merged, is_friction_merged);
    for (int i = 0; i < static_cast<int>(system_.row_blocks.size()); ++i) {
      const RowBlock& block = system_.row_blocks[i];
      if (is_block_merged[i] != 0 || found.is_pin[i] != 0 || !is_guide(system_, block)) continue;
      const RowSpec& across = system_.rows[block.first];
      const int a = cluster_of(across.a), b = cluster_of(across.b);
      if (a == b) continue;
      if (is_fit(a, b, found)) add(i, a, b, true);
      else if (is_fit(b, a, found)) add(i, b, a, false);
      else continue;
      found.is_pin[i] = 1;
      found.mechanism_of[std::get<1>(chosen_.back())] = static_cast<int>(found.mechanisms.size());
    }
    return gather();
  }

private:
  [[nodiscard]] int cluster_of(int body) const { return layout_.placements[body].cluster; }

  void hold(const RowSpec& row) {
    const int a = cluster_of(row.a), b = cluster_of(row.b);
    if (a == b) return;
    for (const int k : {a, b})
      if (k >= 0) ++held_[k];
  }

  void count_holds(const std::vector<char>& is_block_merged, const std::vector<char>& is_friction_merged) {
    for (std::size_t i = 0; i < system_.row_blocks.size(); ++i) {
      if (is_block_merged[i] != 0) continue;
      hold(system_.rows[system_.row_blocks[i].first]);
    }
    for (std::size_t f = 0; f < system_.frictions.size(); ++f)
      if (is_friction_merged[f] == 0 && state_.friction[f].phase == FrictionPhase::stick)
        hold(system_.frictions[f].friction->rows(state_.friction[f])[0]);
  }

  [[nodiscard]] bool is_fit(int k, int on, const JointCoordinates& found) const {
    if (k < 0 || is_long_[k] != 0 || (on >= 0 && is_long_[on] != 0)) return false;
    if (held_[k] != 1 || is_carrier_[k] != 0 || found.mechanism_of[k] >= 0) return false;
    return on < 0 || found.mechanism_of[on] < 0;
  }

  // With d the way from b's centre to a's in b's axes, φ the angle of a against b: n·(d + R_φ p_a − p_b) is held.
  void add(int block, int cluster, int on, bool is_a) {
    const RowSpec& across = system_.rows[system_.row_blocks[block].first];
    const RowSpec& angle = system_.rows[system_.row_blocks[block].first + 1];
    const Placement &a = layout_.placements[across.a], &b = layout_.placements[across.b];
    const double held = across.memory >= 0 ? state_.memory[across.memory] : 0.0;
    const double phi = angle.memory >= 0 ? state_.memory[angle.memory] : 0.0;
    const portable::SinCos of_phi = portable::sin_cos(phi);
    const double chi = phi - a.angle + b.angle; // of a's cluster against b's
    const portable::SinCos of_chi = portable::sin_cos(chi);
    const double h = held - across.direction.dot(turned(of_phi.cos, of_phi.sin, across.point_a) - across.point_b);
    const Vec2 n = turned(b.c, b.s, across.direction); // in the axes of b's cluster
    Carriage k;
    k.block = block;
    k.cluster = cluster;
    k.slot = layout_.clusters[cluster].motion;
    k.on_slot = on < 0 ? k_ground : layout_.clusters[on].motion;
    k.mass = layout_.clusters[cluster].mass;
    k.inertia = layout_.clusters[cluster].inertia;
    k.weight = {k.mass * system_.gravity.x(), k.mass * system_.gravity.y()};
    k.across = h + n.dot(b.offset - turned(of_chi.cos, of_chi.sin, a.offset));
    // b's centre as a's cluster sees it is −R_χᵀ (s e + h n).
    const Vec2 across_axis = is_a ? n : Vec2(-turned(of_chi.cos, -of_chi.sin, n));
    k.axis = {across_axis.y(), -across_axis.x()};
    k.angle = is_a ? chi : -chi;
    k.turn_c = of_chi.cos;
    k.turn_s = is_a ? of_chi.sin : -of_chi.sin;
    if (on >= 0) is_carrier_[on] = 1;
    chosen_.emplace_back(on, cluster, k);
  }

  std::unique_ptr<Carriages> gather() {
    if (chosen_.empty()) return nullptr;
    std::stable_sort(chosen_.begin(), chosen_.end(), [](const auto& x, const auto& y) { return std::get<0>(x) < std::get<0>(y); });
    auto result = std::make_unique<Carriages>();
    for (auto& [on, cluster, k] : chosen_) {
      if (on >= 0 && (result->carriers.empty() || result->carriers.back().cluster != on)) {
        Carrier& carrier = result->carriers.emplace_back();
        carrier.cluster = on;
        carrier.slot = layout_.clusters[on].motion;
        carrier.begin = static_cast<int>(result->carriages.size());
        carrier.mass = layout_.clusters[on].mass;
        carrier.inertia = layout_.clusters[on].inertia;
        carrier.weight = {carrier.mass * system_.gravity.x(), carrier.mass * system_.gravity.y()};
      }
      k.carrier = static_cast<int>(result->carriers.size()) - 1;
      result->carriages.push_back(k);
      if (on >= 0) result->carriers.back().end = static_cast<int>(result->carriages.size());
    }
    return result;
  }

  const System& system_;
  const State& state_;
  const Layout& layout_;
  std::vector<int> held_; // by how many joints, drives and sticking frictions
  std::vector<char> is_carrier_;
  std::vector<char> is_long_; // of a row over more than two bodies
  std::vector<std::tuple<int, int, Carriage>> chosen_; // carrier, cluster
};

} // namespace

std::unique_ptr<Carriages> find_carriages(const System& system, const State& state, const Layout& layout,
                                          const std::vector<char>& is_block_merged,
                                          const std::vector<char>& is_friction_merged, JointCoordinates& found) {
  return Finder(system, state, layout).find(is_block_merged, is_friction_merged, found);
}

} // namespace steplap
