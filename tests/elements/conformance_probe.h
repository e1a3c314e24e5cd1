// Evaluates a compiled two-body scene at any pose and velocity, outside of Dynamics: forces of all
// groups, event functions, energy, rows.
#pragma once

#include "elements/catalog.h"
#include "mbd/io/reader.h"
#include "mbd/system/evaluation_arrays.h"
#include "tests/elements/conformance_scenes.h"

#include <limits>
#include <random>

namespace steplap::testing {

using Vec9 = Eigen::Matrix<double, 9, 1>; ///< (x, y, θ) of ground, a, b

struct Pose {
  Vec9 q = Vec9::Zero(), v = Vec9::Zero();
};

inline std::string conformance_text(const ConformanceScene& scene, bool is_mirrored, bool is_swapped = false) {
  std::string text = k_conformance_bodies;
  text += "kind = \"" + std::string(scene.kind) + "\"\n" + scene.text;
  for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@')) {
    if (is_mirrored) text[at + 1] = text[at + 1] == '+' ? '-' : '+';
    text.erase(at, 1);
  }
  const auto replace = [&text](const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
  };
  replace("\"A\"", is_swapped ? "\"on b\"" : "\"on a\"");
  replace("\"B\"", is_swapped ? "\"on a\"" : "\"on b\"");
  return text;
}

class Probe {
public:
  explicit Probe(const ConformanceScene& scene, bool is_mirrored = false, bool is_swapped = false)
      : system_(compile(parse_model(conformance_text(scene, is_mirrored, is_swapped), scene.kind, element_catalog()))),
        state_(system_->initial_state()), motion_(static_cast<std::size_t>(system_->links.slot_count())), arrays_(*system_),
        scratch_(*system_) {
    arrays_.connect(e_, motion_);
    e_.t = 0.1;
    e_.mode = state_.mode.data();
    e_.friction = state_.friction.data();
    e_.bases = state_.bases.data();
    e_.inner = state_.inner.data();
    e_.scratch = scratch_.pointers();
    choose_places();
  }

  [[nodiscard]] const System& system() const { return *system_; }
  [[nodiscard]] const Evaluation& evaluation() const { return e_; }
  [[nodiscard]] State& state() { return state_; }
  [[nodiscard]] const std::vector<Motion<double>>& motion() const { return motion_; }
  [[nodiscard]] const std::vector<double>& event_value() const { return arrays_.event_value; }
  [[nodiscard]] const std::vector<double>& event_derivative() const { return arrays_.event_derivative; }

  void place(const Pose& pose) {
    const std::vector<double> q(pose.q.data(), pose.q.data() + 9), v(pose.v.data(), pose.v.data() + 9);
    place_bodies(q, v, motion_);
    motion_.resize(system_->links.slot_count());
    place_links(system_->links, motion_);
  }
  /// Modes as the laws choose them at this pose; they stay for later poses.
  void choose_modes(const Pose& pose) {
    place(pose);
    for (std::size_t u = 0; u < system_->units.size(); ++u)
      state_.mode[u] = system_->units[u].group->initial_mode(system_->units[u].index, e_);
  }
  /// As if the run had begun at this pose: whether a foot is past the end of its face.
  void start_at(const Pose& pose) {
    place(pose);
    for (const ForceGroup* group : system_->inner_groups) group->relax_inner(motion_.data(), state_.inner.data());
    choose_modes(pose);
  }
  /// Generalised forces on ground, a and b, each about its own centre.
  Vec9 forces(const Pose& pose) {
    place(pose);
    std::vector<BodyForce>& force = arrays_.force;
    std::fill(force.begin(), force.end(), BodyForce{});
    std::fill(arrays_.inner_rate.begin(), arrays_.inner_rate.end(), 0.0);
    e_.dissipation = e_.work = 0.0;
    for (const auto& group : system_->groups) group->add_forces(e_);
    add_link_forces(system_->links, motion_, force);
    Vec9 f;
    for (int i = 0; i < 3; ++i) f.segment<3>(3 * i) << force[i].fx, force[i].fy, force[i].m;
    return f;
  }
  /// As of the last forces().
  [[nodiscard]] const std::vector<double>& inner_rates() const { return arrays_.inner_rate; }
  double potential(const Pose& pose) {
    place(pose);
    double energy = system_->potential_energy(motion_.data());
    for (const ForceGroup* group : system_->inner_groups) energy += group->inner_energy(motion_.data(), state_.inner.data());
    return energy;
  }
  MeasureValue<double> row(const RowSpec& spec, const Pose& pose) {
    place(pose);
    return evaluate_row<true>(spec, motion_.data());
  }
  /// All rows: bilateral, driven, and those along which friction sticks.
  [[nodiscard]] std::vector<RowSpec> rows() const {
    std::vector<RowSpec> all = system_->rows;
    for (std::size_t f = 0; f < system_->frictions.size(); ++f)
      for (std::uint8_t foot = 0; foot < 2; ++foot) {
        if (foot == 1 && system_->element_kinds[system_->frictions[f].element] != "coulomb_stick") continue;
        FrictionState state = state_.friction[f];
        if (system_->element_kinds[system_->frictions[f].element] == "coulomb_stick") state.foot = foot;
        for (int r = 0; r < system_->frictions[f].friction->dimension(); ++r) all.push_back(system_->frictions[f].friction->rows(state)[r]);
      }
    return all;
  }

private:
  // Where friction acts in the reference pose, for what has more places than feet: those of the mirrored scene are its
  // images then.
  void choose_places() {
    Pose start;
    for (int i = 0; i < 3; ++i) start.q.segment<3>(3 * i) = system_->bodies[i].pose;
    place(start);
    for (std::size_t f = 0; f < system_->frictions.size(); ++f) {
      const FrictionElement& friction = *system_->frictions[f].friction;
      if (system_->element_kinds[system_->frictions[f].element] == "polygon_contact") friction.switch_contact_point(e_, state_.friction[f]);
    }
  }

  std::unique_ptr<System> system_;
  State state_;
  std::vector<Motion<double>> motion_;
  EvaluationArrays arrays_;
  FrictionScratches scratch_;
  Evaluation e_;
};

/// Poses around the reference: displacements up to 0.05 (m, rad), velocities up to 1 (m/s, rad/s), which
/// takes contacts and dead bands through all their modes. The ground stays.
class RandomPoses {
public:
  explicit RandomPoses(const System& system, bool is_mirrored = false) : mirror_(is_mirrored ? -1.0 : 1.0) {
    for (int i = 1; i < 3; ++i) reference_.segment<3>(3 * i) = system.bodies[i].pose;
  }
  Pose next() {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Pose pose;
    pose.q = reference_;
    for (int i = 3; i < 9; ++i) {
      const double sign = i % 3 == 1 ? 1.0 : mirror_;
      pose.q[i] += sign * 0.05 * unit(generator_);
      pose.v[i] = sign * unit(generator_);
    }
    return pose;
  }

private:
  double mirror_;
  Vec9 reference_ = Vec9::Zero();
  std::mt19937 generator_{20240611};
};

/// Unit wrench of a measure on ground, a and b: its gradient by all coordinates.
inline Vec9 gradient_of(const RowSpec& row, const MeasureValue<double>& m) {
  Vec9 g = Vec9::Zero();
  g.segment<3>(3 * row.a) += Vec3(m.direction.x, m.direction.y, cross(m.lever_a, m.direction) + m.couple);
  g.segment<3>(3 * row.b) -= Vec3(m.direction.x, m.direction.y, cross(m.lever_b, m.direction) + m.couple);
  return g;
}

/// Pose and velocity of everything, the ground too, turned about the origin by `angle` and moved.
inline Pose moved(const Pose& pose, double angle, const Vec2& shift) {
  Pose result = pose;
  for (int i = 0; i < 3; ++i) {
    result.q.segment<2>(3 * i) = rotated(pose.q.segment<2>(3 * i), angle) + shift;
    result.q[3 * i + 2] += angle;
    result.v.segment<2>(3 * i) = rotated(pose.v.segment<2>(3 * i), angle);
  }
  return result;
}

inline Vec9 turned(const Vec9& wrenches, double angle) {
  Vec9 result = wrenches;
  for (int i = 0; i < 3; ++i) result.segment<2>(3 * i) = rotated(wrenches.segment<2>(3 * i), angle);
  return result;
}

/// x and couples change sign.
inline Vec9 mirrored(Vec9 f) {
  for (int i = 0; i < 9; ++i)
    if (i % 3 != 1) f[i] = -f[i];
  return f;
}

} // namespace steplap::testing
