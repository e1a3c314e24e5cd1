#include "mbd/analysis/landing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace steplap {

namespace {

constexpr double k_same_share = 1e-12;
constexpr int k_most_halvings = 60;

} // namespace

Landing::Landing(const System& system, const Statics& statics) : system_(system), statics_(statics), parent_(system.bodies.size()) {
  std::iota(parent_.begin(), parent_.end(), 0);
  join_bodies();
}

int Landing::island(int body) {
  while (parent_[body] != body) body = parent_[body] = parent_[parent_[body]];
  return body;
}

void Landing::join_bodies() {
  const auto join = [this](int a, int b) {
    if (a != k_ground && b != k_ground) parent_[island(a)] = island(b);
  };
  std::vector<PairJacobian> parts;
  for (const auto& group : system_.groups) group->add_jacobian(statics_.evaluation(), parts);
  for (const PairJacobian& part : parts) {
    const bool is_open = part.contact >= 0 && !(statics_.evaluation().contact_force[part.contact] > 0.0);
    if (is_open) open_.push_back({part.a, part.b, part.contact});
    else if (part.contact >= 0 || (part.stiffness.array() != 0.0).any()) join(part.a, part.b);
  }
  for (const StaticRow& row : statics_.rows()) {
    int last = k_ground; // of a row over several bodies
    for (const RowSpec* part = row.spec; part; part = part->next) {
      join(part->a, part->b);
      const int any = part->a != k_ground ? part->a : part->b;
      join(last, any);
      last = any;
    }
  }
}

VecX Landing::cut_step(const VecX& step, const std::vector<double>& shares) {
  VecX cut = step;
  for (int body = 1; body < system_.body_count(); ++body) cut.segment<3>(3 * (body - 1)) *= shares[island(body)];
  return cut;
}

// The island that goes further at a contact; the ground does not move.
int Landing::mover(const Pair& pair, const VecX& step) {
  const auto size = [&step](int body) { return body == k_ground ? -1.0 : step.segment<3>(3 * (body - 1)).cwiseAbs().maxCoeff(); };
  return island(size(pair.a) >= size(pair.b) ? pair.a : pair.b);
}

bool Landing::cut(VecX& step, const std::vector<double>& looks, const Look& look) {
  if (open_.empty()) return false;
  const double* const force = statics_.evaluation().contact_force;
  std::vector<double> low(parent_.size(), 0.0), high(parent_.size(), 1.0), shares(parent_.size());
  std::vector<std::vector<int>> landed(parent_.size()); // contacts of each island that closed first
  bool is_any = false;
  for (double share = 0.0, before = 0.0; share < 1.0; before = share) {
    double most = 1.0; // of what still moves
    for (int body = 1; body < system_.body_count(); ++body)
      if (high[island(body)] == 1.0) most = std::max(most, looks[body]);
    share = std::min(1.0, share + 1.0 / most);
    for (std::size_t k = 0; k < shares.size(); ++k) shares[k] = std::min(share, high[k]);
    look(cut_step(step, shares));
    for (const Pair& pair : open_) {
      if (!(force[pair.contact] > 0.0)) continue;
      const int moved = mover(pair, step);
      if (!landed[moved].empty() && high[moved] < share) continue; // it has stopped before
      landed[moved].push_back(pair.contact);
      high[moved] = share;
      low[moved] = before;
      is_any = true;
    }
  }
  if (!is_any) return false;
  for (int i = 0; i < k_most_halvings; ++i) {
    bool is_open = false;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const bool is_known = landed[k].empty() || high[k] - low[k] <= k_same_share * high[k];
      shares[k] = is_known ? high[k] : 0.5 * (low[k] + high[k]);
      is_open = is_open || !is_known;
    }
    if (!is_open) break;
    look(cut_step(step, shares));
    for (std::size_t k = 0; k < shares.size(); ++k) {
      if (shares[k] == high[k]) continue;
      const bool is_closed = std::any_of(landed[k].begin(), landed[k].end(), [force](int contact) { return force[contact] > 0.0; });
      (is_closed ? high : low)[k] = shares[k];
    }
  }
  step = cut_step(step, high);
  return true;
}

} // namespace steplap
