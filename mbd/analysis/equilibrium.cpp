#include "mbd/analysis/equilibrium.h"

#include "mbd/friction/friction_modes.h"
#include "mbd/math/portable_math.h"
#include "mbd/simulation/simulation.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_acceleration_tolerance = 1e-9; // m/s²: 1e-10 of gravity
constexpr int k_max_newton = 60;
constexpr int k_max_damped_swings = 400;
constexpr int k_most_looks = 12;      // for a swing's peak
constexpr double k_same_top = 1e-3;   // of the times about it
constexpr double k_swing_time = 20.0; // s of motion before giving up on a swing
constexpr double k_least_used = 1e-9; // share of a friction element's capacity that is rounding

// Accelerations at rest as a function of the clusters' coordinates.
class RestProblem {
public:
  RestProblem(const System& system, State state)
      : system_(system), state_(std::move(state)), dynamics_(system), modes_(system, dynamics_),
        is_anchored_(system.frictions.size(), 0), y_(static_cast<std::size_t>(system.largest_dimension())), dy_(y_.size()) {
    std::fill(state_.v.begin(), state_.v.end(), 0.0);
  }

  // Modes from the gaps as they are now; friction sticks where it is loaded, as long as it is.
  void update_modes() {
    evaluate_state();
    for (std::size_t u = 0; u < system_.units.size(); ++u)
      state_.mode[u] = system_.units[u].group->initial_mode(system_.units[u].index, dynamics_.evaluation());
    for (std::size_t f = 0; f < system_.frictions.size(); ++f) {
      FrictionState& friction = state_.friction[f];
      if (friction.phase == FrictionPhase::apart) continue;
      const bool is_loaded = system_.frictions[f].friction->is_loaded(dynamics_.evaluation(), friction);
      friction.phase = is_loaded ? FrictionPhase::stick : FrictionPhase::free;
      if (is_loaded && !is_anchored_[f]) modes_.set_anchor(state_, static_cast<int>(f));
      is_anchored_[f] = is_loaded;
    }
    evaluate_state();
  }

  double newton_step() {
    const int n = dynamics_.coordinate_count();
    const Eigen::VectorXd a = accelerations();
    const double before = scaled_norm(a);
    Eigen::MatrixXd jacobian(n, n);
    std::vector<double> moved(y_);
    for (int i = 0; i < n; ++i) {
      const double h = 1e-7;
      moved = y_;
      moved[i] += h;
      const Eigen::VectorXd up = accelerations(moved);
      moved[i] -= 2.0 * h;
      jacobian.col(i) = (up - accelerations(moved)) / (2.0 * h);
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
    decomposition.setThreshold(1e-10);
    decomposition.compute(jacobian);
    const Eigen::VectorXd step = decomposition.solve(-a);
    const std::vector<double> start = y_;
    for (double factor = 1.0; factor > 1e-3; factor *= 0.5) {
      for (int i = 0; i < n; ++i) y_[i] = start[i] + factor * step[i];
      dynamics_.project(state_.t, y_.data(), 1e-12);
      std::fill(y_.begin() + n, y_.begin() + 2 * n, 0.0);
      dynamics_.unpack(state_.t, y_.data(), state_);
      std::fill(state_.v.begin(), state_.v.end(), 0.0);
      update_modes();
      if (scaled_norm(accelerations()) < before || factor < 2e-3) break;
    }
    return scaled_norm(accelerations());
  }

  [[nodiscard]] double residual() { return scaled_norm(accelerations()); }
  [[nodiscard]] State& state() { return state_; }
  [[nodiscard]] int fastest_body() {
    const Snapshot snapshot = dynamics_.snapshot(dy_.data());
    int worst = 1;
    const auto size = [&](int i) {
      return portable::hypot(snapshot.acceleration[3 * i], snapshot.acceleration[3 * i + 1]);
    };
    for (int i = 2; i < system_.body_count(); ++i)
      if (size(i) > size(worst)) worst = i;
    return worst;
  }
  /// A direction in which the pose would run away, as displacements of the clusters' coordinates; empty
  /// if it is stable. Displacements are taken along the constraints.
  [[nodiscard]] Eigen::VectorXd unstable_direction() {
    const int n = dynamics_.coordinate_count();
    const std::vector<double> start = y_;
    const double h = 1e-5;
    Eigen::MatrixXd moved(n, n), answer(n, n);
    for (int i = 0; i < n; ++i) {
      std::vector<double> y = start;
      y[i] += h;
      dynamics_.rates(state_.t, y.data(), dy_.data());
      dynamics_.project(state_.t, y.data(), 1e-12);
      answer.col(i) = accelerations(y);
      for (int k = 0; k < n; ++k) moved(k, i) = y[k] - start[k];
    }
    const Eigen::VectorXd rest = accelerations();
    answer.colwise() -= rest;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> range;
    range.setThreshold(1e-3);
    range.compute(moved / h);
    const Eigen::Index rank = range.rank();
    if (rank == 0) return {};
    const Eigen::MatrixXd basis =
        Eigen::MatrixXd(range.householderQ()).leftCols(rank);
    const Eigen::MatrixXd inverse = moved.completeOrthogonalDecomposition().pseudoInverse();
    const Eigen::MatrixXd stiffness = basis.transpose() * answer * inverse * basis;
    const Eigen::EigenSolver<Eigen::MatrixXd> modes(stiffness);
    Eigen::Index worst = 0;
    modes.eigenvalues().real().maxCoeff(&worst);
    // 1/s²: neutral directions have zero up to differences of h.
    if (modes.eigenvalues()[worst].real() < 1e-4) return {};
    return basis * modes.eigenvectors().col(worst).real();
  }
  /// The pose moved a little along `direction`.
  [[nodiscard]] State nudged(const Eigen::VectorXd& direction) {
    std::vector<double> y = y_;
    const double scale = 1e-3 / direction.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < direction.size(); ++i) y[i] += scale * direction[i];
    dynamics_.rates(state_.t, y.data(), dy_.data());
    dynamics_.project(state_.t, y.data(), 1e-12);
    State state = state_;
    dynamics_.unpack(state_.t, y.data(), state);
    std::fill(state.v.begin(), state.v.end(), 0.0);
    return state;
  }
  /// Friction elements whose sticking wrench is beyond their bound.
  [[nodiscard]] std::vector<std::string> slipping() {
    evaluate_state();
    std::vector<std::string> names;
    for (std::size_t f = 0; f < system_.frictions.size(); ++f) {
      const FrictionUnit& unit = system_.frictions[f];
      if (state_.friction[f].phase != FrictionPhase::stick) continue;
      if (dynamics_.watch()[unit.watch] < 0.0 || dynamics_.watch()[unit.watch + 1] < 0.0)
        names.push_back(system_.element_names[unit.element]);
    }
    return names;
  }

  /// How far those that stick are from slipping.
  [[nodiscard]] std::vector<FrictionMargin> margins() {
    evaluate_state();
    const Snapshot snapshot = dynamics_.snapshot(dy_.data());
    std::vector<FrictionMargin> found;
    for (std::size_t f = 0; f < system_.frictions.size(); ++f) {
      const FrictionUnit& unit = system_.frictions[f];
      if (state_.friction[f].phase != FrictionPhase::stick || unit.friction->never_slips()) continue;
      found.push_back({static_cast<int>(f), share_used(*unit.friction, state_.friction[f], snapshot.friction_force + unit.row)});
    }
    return found;
  }

private:
  // 1/s for the largest s with s·wrench admissible; the set is convex and holds zero.
  double share_used(const FrictionElement& element, const FrictionState& state, const double* wrench) {
    const auto holds = [&](double factor) {
      double scaled[3] = {0, 0, 0}, watch[2];
      for (int r = 0; r < element.dimension(); ++r) scaled[r] = factor * wrench[r];
      element.watch_stick(dynamics_.evaluation(), state, scaled, watch);
      return watch[0] >= 0.0 && watch[1] >= 0.0;
    };
    double low = -portable::log10(k_least_used), high = low; // of the decimal logarithm of s
    if (holds(portable::pow(10.0, high))) return 0.0;
    for (low = -high; high - low > 1e-12;) {
      const double middle = 0.5 * (low + high);
      (holds(portable::pow(10.0, middle)) ? low : high) = middle;
    }
    return portable::pow(10.0, -low);
  }
  void evaluate_state() {
    dynamics_.set_state(state_);
    dynamics_.pack(state_, y_.data());
    dynamics_.rates(state_.t, y_.data(), dy_.data());
    dynamics_.watch_merged(dy_.data());
  }
  Eigen::VectorXd accelerations() { return accelerations(y_); }
  Eigen::VectorXd accelerations(const std::vector<double>& y) {
    const int n = dynamics_.coordinate_count();
    dynamics_.rates(state_.t, y.data(), dy_.data());
    return Eigen::Map<const Eigen::VectorXd>(dy_.data() + n, n);
  }
  // Driven coordinates move as they must: their accelerations are not a matter of equilibrium.
  [[nodiscard]] double scaled_norm(const Eigen::VectorXd& a) const {
    double largest = 0.0;
    const Layout& layout = dynamics_.layout();
    for (int k = 0; k < layout.cluster_count(); ++k)
      for (int c = 0; c < 3; ++c)
        if (layout.clusters[k].w[c] > 0.0) largest = std::max(largest, std::abs(a[3 * k + c]));
    return largest;
  }

  const System& system_;
  State state_;
  Dynamics dynamics_;
  FrictionModes modes_;
  std::vector<char> is_anchored_; ///< friction elements that hold where they got their load
  std::vector<double> y_, dy_;
};

bool newton(RestProblem& problem, Equilibrium& result) {
  problem.update_modes();
  result.residual = problem.residual();
  double best = result.residual;
  for (int stalled = 0; result.iterations < k_max_newton && stalled < 6; ++result.iterations) {
    if (result.residual <= k_acceleration_tolerance) return true;
    result.residual = problem.newton_step();
    if (!std::isfinite(result.residual)) return false;
    stalled = result.residual < 0.7 * best ? 0 : stalled + 1;
    best = std::min(best, result.residual);
  }
  return result.residual <= k_acceleration_tolerance;
}

// Where the parabola through three points, the middle one the highest, has its top.
double top_of_parabola(const double* t, const double* e) {
  const double before = (e[1] - e[0]) / (t[1] - t[0]), after = (e[2] - e[1]) / (t[2] - t[1]);
  const double curvature = (after - before) / (t[2] - t[0]);
  return curvature < 0.0 ? std::clamp(0.5 * (t[0] + t[1]) - 0.5 * before / curvature, t[0], t[2]) : t[1];
}

SimulationOptions swing_options(double end) {
  SimulationOptions options;
  options.integrator = "dop853";
  options.settings.tolerance = 1e-6;
  options.end = end;
  return options;
}

// One swing: from rest to the first peak of the kinetic energy. Steps alone may come no nearer to it than to a
// place as high as the start, on the other side.
State swing(const System& system, const State& start) {
  Simulation simulation(system, start, swing_options(start.t + k_swing_time));
  double t[3] = {start.t, start.t, start.t}, energy[3] = {0.0, 0.0, 0.0};
  State state = start;
  while (simulation.advance()) {
    const State now = simulation.current_state();
    t[2] = now.t;
    energy[2] = system.kinetic_energy(now);
    if (energy[2] < energy[1]) break;
    std::copy(t + 1, t + 3, t);
    std::copy(energy + 1, energy + 3, energy);
    state = now;
  }
  // Few steps make a swing: the parabola's top is looked at and takes the place of one of the three, until it stays.
  for (int look = 0; look < k_most_looks && energy[2] < energy[1] && t[0] < t[1]; ++look) {
    const double top = top_of_parabola(t, energy);
    if (std::abs(top - t[1]) < k_same_top * (t[2] - t[0])) break;
    Simulation to_top(system, start, swing_options(top));
    to_top.run();
    const State there = to_top.current_state();
    const double reached = system.kinetic_energy(there);
    const bool is_higher = reached > energy[1], is_later = top > t[1];
    const int replaced = is_higher == is_later ? 0 : 2;
    t[replaced] = is_higher ? t[1] : top;
    energy[replaced] = is_higher ? energy[1] : reached;
    if (!is_higher) continue;
    t[1] = top;
    energy[1] = reached;
    state = there;
  }
  state.t = start.t;
  std::fill(state.v.begin(), state.v.end(), 0.0);
  return state;
}

} // namespace

Equilibrium find_equilibrium(const System& system, const State& start) {
  Equilibrium result;
  State from = start;
  start_drives(system, from);
  for (int attempt = 0; attempt < k_max_damped_swings; ++attempt) {
    RestProblem problem(system, from);
    result.iterations = 0;
    bool is_found = false;
    // Newton is tried at once, then after every few swings.
    if (attempt % 5 == 0) is_found = newton(problem, result);
    if (is_found) {
      // A pose that the least nudge would leave is no rest: it is left, and the swing goes on.
      if (const Eigen::VectorXd away = problem.unstable_direction(); away.size() > 0) {
        from = swing(system, problem.nudged(away));
        from.dissipated = from.work = 0.0;
        continue;
      }
      result.slipping = problem.slipping();
      result.margins = problem.margins();
      result.state = problem.state();
      result.state.v = start.v;
      for (std::size_t i = 3; i < start.q.size(); ++i)
        if (i % 3 < 2) result.moved = std::max(result.moved, std::abs(result.state.q[i] - start.q[i]));
      return result;
    }
    const State next = swing(system, from);
    double moved = 0.0;
    for (std::size_t i = 0; i < next.q.size(); ++i) moved = std::max(moved, std::abs(next.q[i] - from.q[i]));
    if (moved > 1e3) break;
    from = next;
    from.dissipated = from.work = 0.0;
  }
  RestProblem problem(system, from);
  problem.update_modes();
  throw NumericalFailure("no static equilibrium found: '" + system.bodies[problem.fastest_body()].name +
                         "' keeps moving; is something missing that holds it?");
}

} // namespace steplap
