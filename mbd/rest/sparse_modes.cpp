#include "mbd/rest/sparse_modes.h"

#include "mbd/base/decompositions.h"
#include "mbd/rest/free_vibration.h"
#include "mbd/rest/shifted_vibration.h"
#include "mbd/rest/spread.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

namespace steplap {

namespace {

using Complex = std::complex<double>;
using ComplexVector = Eigen::VectorXcd;

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
constexpr double k_new = 1e-9;              // fraction of a vector's length: least part outside the basis that counts as a new direction
constexpr double k_residual = 1e-9;         // largest residual, relative to the mode's own acceleration
constexpr double k_out_of_balance = 1e-4;   // largest residual if W spans all motions of the model and cannot grow
constexpr double k_rounded_terms = 32.0;    // epsilons of the terms in a residual
constexpr double k_same = 1e-6;             // relative difference of squared frequencies that count as equal
constexpr double k_well_below = 1.0 / 64.0; // ratio of σ² to the square of the first frequency
constexpr int k_starts = 3;                 // starting vectors, in addition to one for each rigid motion
constexpr int k_beyond = 2;                 // modes after the last wanted one that must be known too
constexpr int k_most_rigid = 200;

// The basis W, with the Krylov vectors as components in it.
class MotionSpace {
public:
  MotionSpace(const SparseVibration& scene, Complex sigma, double rate, int most)
      : scene_(scene), sigma_(sigma), rate_(rate), most_(most), w_(scene.coordinates(), most) {
    if (!response_.factor(scene, sigma)) throw NumericalFailure("the vibrations' equations are singular where modes are looked for");
  }

  [[nodiscard]] auto directions() const { return w_.leftCols(size_); }
  [[nodiscard]] int size() const { return size_; }

  // Adds a starting vector: the response to pseudo-random forces that do no work on W. Otherwise modes that are known already would
  // dominate. Returns false if no direction is left.
  bool add_start() {
    VecX x = spread_.vector(scene_.coordinates()).cwiseQuotient(scene_.mass().cwiseSqrt());
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (scene_.bare()[static_cast<std::size_t>(i)] != 0) x[i] = 0.0;
    for (int round = 0; round < 2; ++round) x -= w_.leftCols(size_) * (w_.leftCols(size_).transpose() * scene_.mass().cwiseProduct(x));
    const VecX f = scene_.mass().cwiseProduct(x);
    const int before = size_;
    ComplexVector g = ComplexVector::Zero(most_);
    take(response_.solve(f.cast<Complex>()), g);
    if (size_ == before) return false;
    ComplexVector u = ComplexVector::Zero(2 * most_);
    u[before] = 1.0;
    push(u);
    return true;
  }

  // Expands W to `wanted` directions. Returns false if the Krylov vectors do not give so many.
  bool grow(int wanted) {
    while (size_ < wanted && next_ < vectors_.size()) expand(vectors_[next_++]);
    return size_ >= wanted;
  }

private:
  void expand(const ComplexVector& u) {
    const ComplexVector g = u.head(most_), h = u.tail(most_);
    const ComplexVector q = w_.leftCols(size_) * g.head(size_), v = rate_ * (w_.leftCols(size_) * h.head(size_));
    const ComplexVector inertia = v + sigma_ * q;
    ComplexVector f = -(scene_.damping() * q);
    f -= scene_.mass().cwiseProduct(inertia.real()) + Complex(0.0, 1.0) * scene_.mass().cwiseProduct(inertia.imag());
    ComplexVector at = ComplexVector::Zero(most_);
    take(response_.solve(f), at);
    ComplexVector next(2 * most_);
    next << at, (g + sigma_ * at) / rate_;
    push(next);
  }

  // Adds the components of a displacement along W to `at`. A part of the displacement outside W becomes a new direction of W.
  void take(const ComplexVector& a, ComplexVector& at) {
    take_part(a.real(), Complex(1.0), at);
    if (sigma_.imag() != 0.0 || a.imag().cwiseAbs().maxCoeff() > 0.0) take_part(a.imag(), Complex(0.0, 1.0), at);
  }
  void take_part(VecX x, Complex unit, ComplexVector& at) {
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (scene_.bare()[static_cast<std::size_t>(i)] != 0) x[i] = 0.0;
    const double whole = length(x);
    if (!(whole > 0.0)) return;
    for (int round = 0; round < 2; ++round) {
      const VecX along = w_.leftCols(size_).transpose() * scene_.mass().cwiseProduct(x);
      x -= w_.leftCols(size_) * along;
      at.head(size_) += unit * along;
    }
    const double beyond = length(x);
    if (beyond <= k_new * whole || size_ == most_) return;
    w_.col(size_) = x / beyond;
    at[size_++] += unit * beyond;
  }
  [[nodiscard]] double length(const VecX& x) const { return std::sqrt(x.cwiseAbs2().dot(scene_.mass())); }

  void push(ComplexVector u) {
    const double whole = u.norm();
    for (int round = 0; round < 2; ++round)
      for (const ComplexVector& before : vectors_) u -= before.dot(u) * before;
    const double beyond = u.norm();
    if (beyond > k_new * whole) vectors_.push_back(u / beyond);
  }

  const SparseVibration& scene_;
  const Complex sigma_;
  double rate_; ///< 1/s; velocities are divided by this to have the size of displacements
  const int most_;
  int size_ = 0;
  MatX w_;
  std::vector<ComplexVector> vectors_; ///< q = W · head, v = rate · W · tail
  std::size_t next_ = 0;
  ShiftedResponse response_;
  Spread spread_;
};

class Search {
public:
  Search(const System& system, State& state, const WantedModes& wanted) : scene_(system, state), wanted_(wanted) {
    // Bare coordinates are rigid motions, which are counted separately.
    directions_ = scene_.free_count() - scene_.bare_count();
  }

  SparseModes run() {
    found_.rigid_motions = scene_.bare_count();
    if (directions_ <= 0) return all_found();
    rigid_ = scene_.count_below(scene_.loose());
    if (rigid_ > k_most_rigid)
      throw NumericalFailure("nothing holds the scene along " + std::to_string(rigid_ + scene_.bare_count()) +
                             " coordinates: its vibrations are not looked for among so many rigid motions (up to " +
                             std::to_string(k_most_rigid) + " are passed by)");
    const auto sigma = expansion_point();
    if (!sigma) {
      found_.rigid_motions += rigid_;
      return all_found();
    }
    const int most = std::min(directions_, 10 * wanted_.count + 2 * rigid_ + 200);
    MotionSpace space(scene_, *sigma, std::max(size_of(*sigma), std::sqrt(scene_.loose())), most);
    for (int i = 0; i < k_starts + rigid_ && space.add_start(); ++i) {}
    for (int wanted = std::min(most, 3 * wanted_.count + 2 * rigid_ + 20);; wanted = std::min(most, wanted + wanted / 2)) {
      while (!space.grow(wanted) && space.add_start()) {}
      const bool is_whole = space.size() == directions_, is_found = look(space);
      if (is_found || (is_whole && worst_ < k_out_of_balance)) return finished(is_whole);
      if (is_whole || space.size() < wanted || space.size() >= most) fail();
      for (int i = 0; i < k_starts && space.add_start(); ++i) { // a frequency may have more modes than the number of starting vectors
      }
    }
  }

private:
  SparseModes all_found() {
    found_.is_all = found_.is_counted = true;
    return std::move(found_);
  }
  SparseModes finished(bool is_whole) {
    found_.is_all = is_whole && !has_more_;
    found_.is_counted = is_whole || found_.is_counted;
    return std::move(found_);
  }

  // Returns the shift σ; nothing if the only motions of the model are at constant velocity.
  std::optional<Complex> expansion_point() {
    if (wanted_.near && *wanted_.near > 0.0) return Complex(0.0, 2.0 * std::numbers::pi * *wanted_.near);
    if (rigid_ == 0) return Complex(0.0);
    double s = 8.0 * scene_.loose();
    while (s < 8.0 * scene_.stiffest() && scene_.count_below(s) <= rigid_) s *= 8.0;
    if (s < 8.0 * scene_.stiffest()) return Complex(std::sqrt(k_well_below * s));
    if (scene_.is_damped()) return Complex(1e-3 * scene_.fastest_decay());
    return std::nullopt;
  }

  // Computes the modes along W. Returns true if the wanted ones are accurate and none is missing.
  bool look(const MotionSpace& space) {
    FreeVibration v;
    v.basis = space.directions();
    v.a = -(v.basis.transpose() * (scene_.stiffness() * v.basis));
    v.b = -(v.basis.transpose() * (scene_.damping() * v.basis));
    const SparseVibration::Sparse sizes = scene_.stiffness().cwiseAbs();
    v.separate_null_motions([&sizes](const MatX& shapes) { return MatX(sizes * shapes.cwiseAbs()); });
    found_.rigid_motions = scene_.bare_count() + static_cast<int>(v.loose.cols());
    std::vector<FreeMode> modes = modes_of(v);
    std::stable_sort(modes.begin(), modes.end(), [this](const FreeMode& one, const FreeMode& other) {
      return wanted_.distance(one.eigenvalue) < wanted_.distance(other.eigenvalue);
    });
    const auto count = std::min(modes.size(), static_cast<std::size_t>(wanted_.count));
    has_more_ = modes.size() > count;
    found_.modes.clear();
    unsure_ = 0;
    worst_ = 0.0;
    for (std::size_t i = 0; i < std::min(modes.size(), count + k_beyond); ++i) {
      SparseModes::Mode mode{modes[i].eigenvalue, v.basis * modes[i].x, 0.0};
      if (!measure(mode)) ++unsure_;
      if (i >= count) continue;
      worst_ = std::max(worst_, mode.residual);
      mode.q = scene_.scale().cast<Complex>().cwiseProduct(mode.q);
      found_.modes.push_back(std::move(mode));
    }
    if (unsure_ > 0 || modes.size() < count + k_beyond || static_cast<int>(v.loose.cols()) < rigid_) return false;
    return is_complete(v);
  }

  // Projects a mode onto the rows and computes its residual. Returns false if the residual is too large.
  bool measure(SparseModes::Mode& mode) const {
    const Complex i(0.0, 1.0), l = mode.eigenvalue;
    const auto along_rows = [this, i](const ComplexVector& f) -> ComplexVector {
      return scene_.acceleration(f.real()).cast<Complex>() + i * scene_.acceleration(f.imag()).cast<Complex>();
    };
    const ComplexVector mass = scene_.mass().cast<Complex>();
    mode.q = along_rows(mass.cwiseProduct(mode.q));
    for (Eigen::Index k = 0; k < mode.q.size(); ++k)
      if (scene_.bare()[static_cast<std::size_t>(k)] != 0) mode.q[k] = 0.0;
    const ComplexVector kq = scene_.stiffness() * mode.q, dq = scene_.damping() * mode.q, mq = mass.cwiseProduct(mode.q);
    const ComplexVector left = along_rows(l * l * mq + l * dq + kq);
    const auto length = [this](const VecX& x) { return std::sqrt(x.cwiseAbs2().dot(scene_.mass())); };
    const auto size = [](const ComplexVector& x) { return VecX(x.real().cwiseAbs() + x.imag().cwiseAbs()); };
    const double rate = size_of(l), own = rate * rate * length(size(mode.q));
    mode.residual = length(size(left)) / own;
    const VecX terms = SparseVibration::Sparse(scene_.stiffness().cwiseAbs()) * size(mode.q) +
                       rate * (SparseVibration::Sparse(scene_.damping().cwiseAbs()) * size(mode.q)) + rate * rate * size(mq);
    const double rounding = k_rounded_terms * k_epsilon * length(terms.cwiseQuotient(scene_.mass())) / own;
    return mode.residual <= std::max(k_residual, rounding);
  }

  bool is_complete(const FreeVibration& v) {
    if (!wanted_.near || *wanted_.near == 0.0) {
      const double last = size_of(found_.modes.back().eigenvalue);
      found_.is_counted = scene_.is_symmetric() && is_full_below(v, (1.0 - k_same) * last * last);
      return found_.is_counted || !scene_.is_symmetric();
    }
    if (!scene_.is_symmetric() || scene_.is_damped()) return true;
    return found_.is_counted = are_all_within();
  }

  // Returns true if W has as many directions softer than s as the model has.
  bool is_full_below(const FreeVibration& v, double s) {
    if (s <= scene_.loose()) return true;
    MatX less = -0.5 * (v.a + v.a.transpose());
    less.diagonal().array() -= s;
    const VecX values = symmetric_eigen(less).values;
    return (values.array() < 0.0).count() == scene_.count_below(s);
  }

  // For undamped models near a frequency: returns true if the number of modes found equals the number of modes within the distance of the
  // farthest one, on both sides of the frequency.
  bool are_all_within() {
    const double middle = 2.0 * std::numbers::pi * *wanted_.near;
    double reach = 0.0;
    for (const SparseModes::Mode& mode : found_.modes) reach = std::max(reach, wanted_.distance(mode.eigenvalue));
    reach *= 1.0 - k_same;
    int found = 0;
    for (const SparseModes::Mode& mode : found_.modes) found += wanted_.distance(mode.eigenvalue) < reach ? 1 : 0;
    const double low = middle - reach, high = middle + reach;
    const int below = low > 0.0 && low * low > scene_.loose() ? scene_.count_below(low * low) : rigid_;
    return scene_.count_below(high * high) - below == found;
  }

  [[noreturn]] void fail() const {
    const std::string size = std::to_string(wanted_.count) + " modes";
    if (unsure_ > 0)
      throw NumericalFailure("of the " + size + " wanted some do not converge: " + std::to_string(unsure_) +
                             " of them are out of balance by more than " + std::to_string(k_residual) + " of their own acceleration");
    throw NumericalFailure("of the " + size +
                           " wanted some are missing: so many are of one frequency, or of nearly one. Ask for more, or for "
                           "fewer than come to it");
  }

  SparseVibration scene_;
  const WantedModes& wanted_;
  int directions_ = 0;    ///< number of directions that are neither bare nor held by rows
  int rigid_ = 0;         ///< number of rigid motions among them
  int unsure_ = 0;        ///< modes that are not accurate enough
  double worst_ = 0.0;    ///< largest residual
  bool has_more_ = false; ///< more modes exist than are wanted
  SparseModes found_;
};

} // namespace

SparseModes sparse_modes(const System& system, State state, const WantedModes& wanted) { return Search(system, state, wanted).run(); }

} // namespace steplap
