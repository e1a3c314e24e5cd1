#include "mbd/simulation/power_ledger.h"

#include <algorithm>
#include <array>
#include <utility>

namespace steplap {

namespace {

constexpr int k_most = 7;
using Basis = std::array<std::array<double, k_most>, k_most>; // basis[k][p]: coefficient of θ^p in the Lagrange polynomial of node k

constexpr std::array<double, 7> k_seven = {0.0, 0.5 - 0.5 * 0.83022389627856693, 0.5 - 0.5 * 0.46884879347071421,
                                           0.5, 0.5 + 0.5 * 0.46884879347071421, 0.5 + 0.5 * 0.83022389627856693,
                                           1.0};
constexpr std::array<double, 3> k_three = {0.0, 0.5, 1.0};

Basis basis_of(const double* node, int count) {
  Basis basis{};
  for (int j = 0; j < count; ++j) {
    std::array<double, k_most>& p = basis[j];
    p[0] = 1.0;
    int degree = 0;
    for (int i = 0; i < count; ++i) {
      if (i == j) continue;
      const double scale = 1.0 / (node[j] - node[i]);
      ++degree;
      for (int k = degree; k >= 0; --k) p[k] = scale * ((k > 0 ? p[k - 1] : 0.0) - node[i] * p[k]);
    }
  }
  return basis;
}

struct Rule {
  const double* node;
  int count;
  Basis basis;
};

const Rule& rule_for(bool is_adaptive) {
  static const Rule fine{k_seven.data(), 7, basis_of(k_seven.data(), 7)}, plain{k_three.data(), 3, basis_of(k_three.data(), 3)};
  return is_adaptive ? fine : plain;
}

double integral(const double* coefficient, int count, double theta) {
  double sum = 0.0;
  for (int k = count - 1; k >= 0; --k) sum = theta * (sum + coefficient[k] / (k + 1));
  return sum;
}

} // namespace

PowerLedger::PowerLedger(const System& system, int max_dimension, std::vector<Impact> impacts)
    : system_(system), impacts_before_(std::move(impacts)), count_(system.integrands.size()), pieces_(k_kept), total_(count_, 0.0),
      stored_(count_, 0.0), y_(static_cast<std::size_t>(max_dimension)), dy_(y_.size()) {
  for (Piece& piece : pieces_) {
    piece.base.resize(count_);
    piece.coefficient.resize(count_ * k_nodes);
  }
  has_stored_ =
      std::any_of(system.integrands.begin(), system.integrands.end(), [](const Integrand& i) { return static_cast<bool>(i.stored); });
}

PowerLedger::Piece& PowerLedger::next_piece(double t0, double h) {
  last_ = known_ == 0 ? 0 : (last_ + 1) % k_kept;
  known_ = std::min(known_ + 1, k_kept);
  Piece& piece = pieces_[last_];
  piece.t0 = t0;
  piece.h = h;
  piece.base = total_;
  std::fill(piece.coefficient.begin(), piece.coefficient.end(), 0.0);
  return piece;
}

void PowerLedger::close(const Piece& piece) {
  for (std::size_t i = 0; i < count_; ++i) total_[i] += piece.h * integral(&piece.coefficient[i * k_nodes], k_nodes, 1.0);
  t_ = piece.t0 + piece.h;
}

void PowerLedger::end(const Snapshot& snapshot) {
  for (std::size_t i = 0; i < count_; ++i)
    if (const auto& stored = system_.integrands[i].stored) stored_[i] = stored(snapshot);
  is_ended_ = true;
}

void PowerLedger::begin(double t, const Snapshot& snapshot) {
  // At the start, energy lost by initial impacts is counted from State::impacts before those impacts.
  if (known_ == 0) {
    Snapshot unhurt = snapshot;
    unhurt.impacts = impacts_before_.data();
    for (std::size_t i = 0; i < count_; ++i)
      if (const auto& stored = system_.integrands[i].stored) total_[i] += stored(unhurt) - stored(snapshot);
  }
  if (is_ended_)
    for (std::size_t i = 0; i < count_; ++i)
      if (const auto& stored = system_.integrands[i].stored) total_[i] += stored_[i] - stored(snapshot);
  is_ended_ = false;
  next_piece(t, 0.0);
  t_ = t;
}

void PowerLedger::add_step(double t, Integrator& integrator, Dynamics& dynamics) {
  const double t0 = integrator.t0(), h = t - t0;
  if (!(h > 0.0)) return;
  const Rule& rule = rule_for(integrator.is_adaptive());
  Piece& piece = next_piece(t0, h);
  for (int j = 0; j < rule.count; ++j) {
    const double at = j + 1 == rule.count ? t : t0 + rule.node[j] * h;
    integrator.dense(dynamics, std::clamp((at - t0) / integrator.h(), 0.0, 1.0), y_.data());
    dynamics.rates(at, y_.data(), dy_.data());
    const Snapshot snapshot = dynamics.snapshot(dy_.data());
    for (std::size_t i = 0; i < count_; ++i) {
      const double power = system_.integrands[i].power(snapshot);
      for (int k = 0; k < rule.count; ++k) piece.coefficient[i * k_nodes + k] += power * rule.basis[j][k];
    }
  }
  close(piece);
}

void PowerLedger::add_stepped(double t, const Snapshot& snapshot) {
  if (!(t > t_)) return;
  Piece& piece = next_piece(t_, t - t_);
  for (std::size_t i = 0; i < count_; ++i) piece.coefficient[i * k_nodes] = system_.integrands[i].power(snapshot);
  close(piece);
}

double PowerLedger::value(int slot, double t) const {
  if (known_ == 0) return 0.0;
  std::size_t at = last_;
  for (std::size_t back = 1; back < known_ && pieces_[at].t0 > t; ++back) at = (at + k_kept - 1) % k_kept;
  const Piece& piece = pieces_[at];
  const auto i = static_cast<std::size_t>(slot);
  if (!(piece.h > 0.0)) return piece.base[i];
  const double theta = std::clamp((t - piece.t0) / piece.h, 0.0, 1.0);
  return piece.base[i] + piece.h * integral(&piece.coefficient[i * k_nodes], k_nodes, theta);
}

} // namespace steplap
