#include "mbd/rest/assembly.h"

#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/dynamics/dynamics.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>

namespace steplap {

namespace {

constexpr int k_max_steps = 300;
// Fraction of the bodies' size. If the given poses are nearer than this to the joints, one projection suffices, because its distance
// exceeds the least one only in second order.
constexpr double k_near = 1e-9;
// Largest part of the distance along the constraints, relative to the whole distance, at which the search ends.
constexpr double k_stationary = 1e-12;
// Relative change of distances below which rounding decides whether a distance has decreased.
constexpr double k_verifiable = 1e-6;

// Finds a pose on the constraints with a stationary distance Σ m Δx² + m Δy² + J Δθ² to the given pose. Starting from the first projection,
// each step goes along the constraints towards the given pose and is projected. Step lengths follow Barzilai and Borwein (IMA J. Numer.
// Anal. 8 (1988) 141), safeguarded as by Grippo, Lampariello and Lucidi (SIAM J. Numer. Anal. 23 (1986) 707): a distance must be below the
// largest of the last few.
class LeastMotion {
public:
  LeastMotion(Dynamics& dynamics, double t, double tolerance)
      : dynamics_(dynamics), t_(t), tolerance_(tolerance), n_(dynamics.coordinate_count()) {
    weight_.resize(n_);
    for (int i = 0; i < n_; ++i) {
      const Cluster& cluster = dynamics.layout().clusters[i / 3];
      const double mass = i % 3 < 2 ? cluster.mass : cluster.inertia;
      weight_[i] = cluster.w[i % 3] == 0.0 ? 0.0 : mass; // a coordinate fixed by a drive keeps the value of the drive
    }
  }

  /// Refines poses that satisfy the constraints. Velocities do not change.
  void refine(std::vector<double>& y, const std::vector<double>& given) {
    given_ = &given;
    std::vector<double> back = way_back(y);
    if (norm2(back) <= k_near * k_near * size2()) return;
    std::deque<double> last{norm2(back)};
    std::vector<double> allowed = along_constraints(y, back);
    double length = 1.0;
    for (int i = 0; i < k_max_steps && norm2(allowed) > k_stationary * k_stationary * last.back(); ++i) {
      std::vector<double> next;
      if (!step(y, allowed, last, length, next)) return;
      back = way_back(next);
      const std::vector<double> turned = along_constraints(next, back);
      length = next_length(y, next, allowed, turned);
      // If the distance changes by rounding only, its part along the constraints must decrease instead.
      if (norm2(turned) >= norm2(allowed) && norm2(allowed) < k_verifiable * k_verifiable * last.back()) return;
      y = std::move(next);
      allowed = turned;
      last.push_back(norm2(back));
      if (last.size() > 5) last.pop_front();
    }
  }

private:
  [[nodiscard]] std::vector<double> way_back(const std::vector<double>& y) const {
    std::vector<double> back(n_);
    for (int i = 0; i < n_; ++i) back[i] = weight_[i] > 0.0 ? (*given_)[i] - y[i] : 0.0;
    return back;
  }
  [[nodiscard]] std::vector<double> along_constraints(const std::vector<double>& y, std::vector<double> change) const {
    (void)dynamics_.residual(t_, y.data());
    dynamics_.project_onto_null_space(change.data());
    return change;
  }
  [[nodiscard]] double dot(const std::vector<double>& a, const std::vector<double>& b) const {
    double sum = 0.0;
    for (int i = 0; i < n_; ++i) sum += weight_[i] * a[i] * b[i];
    return sum;
  }
  [[nodiscard]] double norm2(const std::vector<double>& a) const { return dot(a, a); }
  [[nodiscard]] double size2() const {
    double sum = 0.0;
    for (int i = 2; i < n_; i += 3) sum += weight_[i]; // Σ J: all bodies turned by one radian
    return sum;
  }

  // Takes a step along the constraints and projects it. The step is halved until the distance does not increase. Returns false if no length
  // succeeds.
  bool step(const std::vector<double>& y, const std::vector<double>& allowed, const std::deque<double>& last, double length,
            std::vector<double>& next) const {
    constexpr int k_max_halvings = 40;
    constexpr double k_decrease = 1e-4;
    const double limit = *std::max_element(last.begin(), last.end());
    const double rounding = 1e-13 * limit;
    for (int i = 0; i < k_max_halvings; ++i, length *= 0.5) {
      next = y;
      for (int k = 0; k < n_; ++k) next[k] += length * allowed[k];
      try {
        dynamics_.project(t_, next.data(), tolerance_);
      } catch (const ConstraintFailure&) {
        continue;
      }
      if (norm2(way_back(next)) <= limit - k_decrease * length * norm2(allowed) + rounding) return true;
    }
    return false;
  }

  [[nodiscard]] double next_length(const std::vector<double>& y, const std::vector<double>& next, const std::vector<double>& before,
                                   const std::vector<double>& now) const {
    constexpr double k_shortest = 1e-3, k_longest = 10.0;
    std::vector<double> moved(n_), changed(n_);
    for (int i = 0; i < n_; ++i) {
      moved[i] = next[i] - y[i];
      changed[i] = before[i] - now[i];
    }
    const double along = dot(moved, changed);
    return along > 0.0 ? std::clamp(norm2(moved) / along, k_shortest, k_longest) : 1.0;
  }

  Dynamics& dynamics_;
  double t_, tolerance_;
  int n_;
  std::vector<double> weight_;
  const std::vector<double>* given_ = nullptr;
};

// Returns poses that satisfy the joints, computed with equal masses and radii of gyration for all bodies. With a light body between heavy
// ones, rows are nearly dependent in the mass metric, and the projection, which is damped then, fails far from the joints. With equal
// masses rows are dependent only if the joints are.
State closed_by_shape(const Model& model, const State& given, double tolerance) {
  Model even = model;
  double square = 0.0; // square of the largest radius of gyration
  for (const Body& body : even.bodies)
    if (!body.fixed) square = std::max(square, body.inertia / body.mass);
  for (Body& body : even.bodies) {
    body.mass = 1.0;
    body.inertia = square;
  }
  const std::unique_ptr<System> system = compile(even);
  State state = given;
  Dynamics dynamics(*system);
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension());
  dynamics.pack(state, y.data());
  dynamics.project(state.t, y.data(), tolerance);
  dynamics.unpack(state.t, y.data(), state);
  state.v = given.v;
  return state;
}

// Projects y onto the joints; if that fails, with equal masses first. If both fail, the error reports the residual with the masses of the
// model.
void close_joints(const Model& model, const State& state, Dynamics& dynamics, std::vector<double>& y) {
  const double tolerance = model.simulation.projection_tolerance;
  try {
    dynamics.project(state.t, y.data(), tolerance);
  } catch (const ConstraintFailure& failure) {
    try {
      dynamics.pack(closed_by_shape(model, state, tolerance), y.data());
      dynamics.project(state.t, y.data(), tolerance);
    } catch (const ConstraintFailure&) {
      throw ConstraintFailure(failure);
    }
  }
}

// Throws if positions are so far apart that their squares overflow.
void require_finite(const Model& model, const System& system, const State& state) {
  const auto is_finite = [](double x) { return std::isfinite(x); };
  const char* const remedy = ": distances are beyond what numbers hold; move bodies and markers nearer to each other";
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    if (is_finite(state.q[i]) && is_finite(state.v[i])) continue;
    const std::string& name = system.bodies[i / 3].name;
    const Body* const body = model.find_body(name);
    throw ModelError(body ? body->where : Location{}, "body '" + name + "' cannot be placed" + remedy);
  }
  const auto is_base_finite = [&](const RowBase& base) { return is_finite(base.value) && is_finite(base.rate); };
  for (const RowSpec& row : system.rows)
    if (row.base >= 0 && !is_base_finite(state.bases[static_cast<std::size_t>(row.base)]))
      throw ModelError(model.elements[static_cast<std::size_t>(row.element)].element->where,
                       "'" + system.element_names[static_cast<std::size_t>(row.element)] + "' has no length or angle" + remedy);
  if (!std::all_of(state.bases.begin(), state.bases.end(), is_base_finite) ||
      !std::all_of(state.inner.begin(), state.inner.end(), is_finite))
    throw ModelError(Location{model.bodies.front().where.file}, std::string("the model cannot begin") + remedy);
}

} // namespace

State assemble(const Model& model, const System& system) {
  State state = system.initial_state();
  start_drives(system, state);
  require_finite(model, system, state);
  // Friction does not move bodies during assembly: a sticking element stays at its pose.
  for (FrictionState& friction : state.friction) friction.phase = FrictionPhase::free;
  Dynamics dynamics(system);
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension());
  dynamics.pack(state, y.data());
  const std::vector<double> given = y;
  const double tolerance = model.simulation.projection_tolerance;
  try {
    close_joints(model, state, dynamics, y);
    LeastMotion(dynamics, state.t, tolerance).refine(y, given);
    std::copy(given.begin() + dynamics.coordinate_count(), given.end(), y.begin() + dynamics.coordinate_count());
    dynamics.project(state.t, y.data(), tolerance);
  } catch (const ConstraintFailure& failure) {
    const ElementEntry& entry = model.elements[failure.element];
    throw ModelError(entry.element->where,
                     entry.kind->name + " '" + entry.element->name + "' cannot be assembled: " +
                         (std::isfinite(failure.residual)
                              ? "with the other joints met it stays " + rounded_text(std::abs(failure.residual)) +
                                    (failure.is_angle ? " rad" : " m") + " off; move the bodies or change the joints"
                              : std::string("distances are beyond what numbers hold; move bodies and markers nearer to each other")));
  }
  dynamics.unpack(state.t, y.data(), state);
  require_finite(model, system, state);
  return state;
}

State assembled_start(const System& system, const State& assembled) {
  State state = system.initial_state();
  state.q = assembled.q;
  state.v = assembled.v;
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  for (const ForceGroup* group : system.inner_groups) group->relax_inner(motion.data(), state.inner.data());
  return state;
}

std::vector<AssemblyMove> assembly_moves(const State& given, const State& assembled, double threshold) {
  std::vector<AssemblyMove> moves;
  for (std::size_t i = 3; i < given.q.size(); i += 3) {
    const auto change = [i](const std::vector<double>& from, const std::vector<double>& to, std::size_t k) {
      return to[i + k] - from[i + k];
    };
    AssemblyMove move;
    move.body = static_cast<int>(i / 3);
    move.shift = portable::hypot(change(given.q, assembled.q, 0), change(given.q, assembled.q, 1));
    move.turn = change(given.q, assembled.q, 2);
    move.velocity = portable::hypot(change(given.v, assembled.v, 0), change(given.v, assembled.v, 1));
    move.angular_velocity = change(given.v, assembled.v, 2);
    if (std::max({move.shift, std::abs(move.turn), move.velocity, std::abs(move.angular_velocity)}) > threshold) moves.push_back(move);
  }
  std::stable_sort(moves.begin(), moves.end(), [](const AssemblyMove& x, const AssemblyMove& y) { return x.shift > y.shift; });
  return moves;
}

} // namespace steplap
