#include "mbd/rest/landing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace steplap {

namespace {

constexpr double k_same_share = 1e-12;
constexpr int k_most_halvings = 60;
constexpr double k_least_measurement = 1e-3; // fraction of a step: least distance of measurements, so at most a thousand of them

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
  std::vector<int> carried;
  for (const auto& group : system_.groups) group->add_jacobian(statics_.evaluation(), parts);
  for (const PairJacobian& part : parts) {
    const bool is_closed = part.contact >= 0 && statics_.evaluation().contact_force[part.contact] > 0.0;
    if (is_closed) carried.insert(carried.end(), {part.a, part.b});
    if (is_closed || (part.stiffness.array() != 0.0).any()) join(part.a, part.b);
    else if (part.contact >= 0) open_.push_back({part.a, part.b, part.contact});
  }
  for (const StaticRow& row : statics_.rows()) {
    int last = k_ground; // a row with several parts connects the bodies of all parts
    for (const RowSpec* part = row.spec; part; part = part->next) {
      join(part->a, part->b);
      const int any = part->a != k_ground ? part->a : part->b;
      join(last, any);
      last = any;
    }
  }
  is_carried_.assign(parent_.size(), 0);
  for (const int body : carried) is_carried_[island(body)] = 1;
  is_carried_[k_ground] = 1;
}

VecX Landing::cut_step(const VecX& step, const std::vector<double>& shares) {
  VecX cut = step;
  for (int body = 1; body < system_.body_count(); ++body) cut.segment<3>(3 * (body - 1)) *= shares[island(body)];
  return cut;
}

// Returns the island that lands when the contact closes: the unsupported one of the two; if both are unsupported, the one that moves
// further. −1 if both are supported, or if both bodies are in one island.
int Landing::lander(const Pair& pair, const VecX& step) {
  const int a = island(pair.a), b = island(pair.b);
  if (a == b || (is_carried_[a] != 0 && is_carried_[b] != 0)) return -1;
  if (is_carried_[a] != is_carried_[b]) return is_carried_[a] != 0 ? b : a;
  const auto size = [&step](int body) { return step.segment<3>(3 * (body - 1)).cwiseAbs().maxCoeff(); };
  return size(pair.a) >= size(pair.b) ? a : b;
}

bool Landing::has_stopped(int island, double share) const { return !landed_[island].empty() && high_[island] < share; }

// Returns the fraction of the step for the next gap measurement, from the required number of measurements and from the safe fraction for
// those islands that still move.
double Landing::next_share(const VecX& step, const std::vector<double>& measurements, const StepProbe& probe, double share) {
  double most = 1.0;
  std::vector<double> moving(parent_.size(), 0.0);
  for (int body = 1; body < system_.body_count(); ++body) {
    if (!landed_[island(body)].empty()) continue;
    most = std::max(most, measurements[body]);
    moving[island(body)] = 1.0;
  }
  const double room = std::max(probe.room(cut_step(step, moving)), k_least_measurement);
  return std::min(1.0, share + std::min(1.0 / most, room));
}

// Finds between which measurements the first contact of each island closes. Returns false if no contact closes, or if one closes at which
// nothing lands.
bool Landing::find_first(const VecX& step, const std::vector<double>& measurements, const StepProbe& probe) {
  const double* const force = statics_.evaluation().contact_force;
  std::vector<double> shares(parent_.size());
  std::vector<char> is_known(open_.size(), 0);
  bool is_any = false;
  for (double share = 0.0, before = 0.0; share < 1.0; before = share) {
    share = next_share(step, measurements, probe, share);
    for (std::size_t k = 0; k < shares.size(); ++k) shares[k] = std::min(share, high_[k]);
    probe.at(cut_step(step, shares));
    for (std::size_t p = 0; p < open_.size(); ++p) {
      if (is_known[p] != 0 || !(force[open_[p].contact] > 0.0)) continue;
      is_known[p] = 1;
      int landing = lander(open_[p], step);
      if (landing < 0) return false;
      if (has_stopped(landing, share)) { // this island has landed already, and the other one hits it
        landing = island(open_[p].a) == landing ? island(open_[p].b) : island(open_[p].a);
        if (is_carried_[landing] != 0 || has_stopped(landing, share)) return false;
      }
      landed_[landing].push_back(open_[p].contact);
      high_[landing] = share;
      low_[landing] = before;
      is_any = true;
    }
  }
  return is_any;
}

// Locates the first contacts of all islands by simultaneous bisections.
void Landing::locate_contact(const VecX& step, const StepProbe& probe) {
  const double* const force = statics_.evaluation().contact_force;
  std::vector<double> shares(parent_.size());
  for (int i = 0; i < k_most_halvings; ++i) {
    bool is_open = false;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const bool is_known = landed_[k].empty() || high_[k] - low_[k] <= k_same_share * high_[k];
      shares[k] = is_known ? high_[k] : 0.5 * (low_[k] + high_[k]);
      is_open = is_open || !is_known;
    }
    if (!is_open) return;
    probe.at(cut_step(step, shares));
    for (std::size_t k = 0; k < shares.size(); ++k) {
      if (shares[k] == high_[k]) continue;
      const bool is_closed = std::any_of(landed_[k].begin(), landed_[k].end(), [force](int contact) { return force[contact] > 0.0; });
      (is_closed ? high_ : low_)[k] = shares[k];
    }
  }
}

bool Landing::cut(VecX& step, const std::vector<double>& measurements, double touch, const StepProbe& probe) {
  low_.assign(parent_.size(), 0.0);
  high_.assign(parent_.size(), 1.0);
  landed_.assign(parent_.size(), {});
  if (open_.empty() || !find_first(step, measurements, probe)) return false;
  locate_contact(step, probe);
  std::vector<double> size(parent_.size(), 0.0);
  for (int body = 1; body < system_.body_count(); ++body)
    size[island(body)] = std::max(size[island(body)], step.segment<3>(3 * (body - 1)).cwiseAbs().maxCoeff());
  for (std::size_t k = 0; k < size.size(); ++k)
    if (!landed_[k].empty() && size[k] > 0.0) high_[k] = std::min(1.0, high_[k] + touch / size[k]);
  step = cut_step(step, high_);
  return true;
}

} // namespace steplap
