#include "mbd/dynamics/traced_mechanism.h"

namespace steplap {

namespace {

MechanismWorkOf<TapeNumber>::Link link_of(const MechanismWork::Link& known) {
  MechanismWorkOf<TapeNumber>::Link link;
  link.parent = known.parent;
  link.coordinate = known.coordinate;
  link.slot = known.slot;
  link.cluster = known.cluster;
  link.is_free = known.is_free;
  link.mass = known.mass;
  link.mass_below = known.mass_below;
  link.turning = known.turning;
  link.pin = known.pin;
  link.centre = known.centre;
  link.moment = known.moment;
  if (known.parent < 0 && !known.is_free) link.o = known.o; // position of its pin on the ground
  return link;
}

} // namespace

TracedMechanism::TracedMechanism(const Mechanism& mechanism) : mechanism_(mechanism) {
  const MechanismWork& known = mechanism.work();
  work_.n = known.n;
  work_.is_chain = known.is_chain;
  work_.gravity = known.gravity;
  work_.up = known.up;
  work_.all = known.all;
  for (const MechanismWork::Link& link : known.links) work_.links.push_back(link_of(link));
  for (const MechanismWork::RowPattern& pattern : known.patterns) work_.patterns.push_back({pattern.count, pattern.at});
  for (const MechanismWork::Shared& pair : known.shared) work_.shared.push_back({pair.begin, pair.count});
  work_.shared_at = known.shared_at;
  const std::size_t rows = known.patterns.size();
  for (auto* numbers : {&work_.gradient, &work_.white, &work_.scaled}) numbers->resize(rows * Mechanism::k_most);
  work_.factor.resize(rows * rows);
  for (auto* numbers : {&work_.inverse_pivot, &work_.own}) numbers->resize(rows);
}

void TracedMechanism::solve_mass(TapeNumber* x) const {
  if (work_.is_chain) work_.solve_chain<0>(x);
  else work_.solve_tree(x);
}

void TracedMechanism::accelerate(const BodyForceOf<TapeNumber>* force, TapeNumber* s) {
  work_.fill_mass();
  if (work_.is_chain) work_.factor_chain<0>();
  else work_.factor_tree();
  work_.load(force, s);
  solve_mass(s);
}

void TracedMechanism::solve_rows(const SchurRowOf<TapeNumber>* rows, double least_pivot, TapeNumber* lambda, TapeNumber* change,
                                 std::vector<TracedPivot>& pivots) {
  const int count = mechanism_.row_count;
  for (int r = 0; r < count; ++r) {
    const auto at = static_cast<std::size_t>(r);
    int member[2] = {-1, -1};
    for (int side = 0; side < 2; ++side)
      if (rows[r].body[side] >= 0) member[side] = mechanism_.member_of(rows[r].body[side]);
    work_.clear_gradient(at);
    work_.reduce(rows[r], member, &work_.gradient[at * Mechanism::k_most]);
  }
  for (int r = 0; r < count; ++r) work_.whiten_row(static_cast<std::size_t>(r), rows[r]);
  work_.factor_rows<0>(
      count, [](const TapeNumber& d, const TapeNumber&) { return d; },
      [&](int, const TapeNumber& d, const TapeNumber& own) {
        if (!(d > least_pivot * own)) throw NotTraceable();
        pivots.push_back({d, own});
        return 1.0 / d;
      });
  work_.eliminate<0>(count, lambda);
  std::array<TapeNumber, Mechanism::k_most> pull;
  work_.pull_rows(count, lambda, pull.data());
  solve_mass(pull.data());
  for (int i = 0; i < work_.n; ++i) change[i] += pull[static_cast<std::size_t>(i)];
}

} // namespace steplap
