#include "mbd/integrators/row_compliance.h"

#include <algorithm>

namespace steplap {

namespace {

// Capacity is reserved in advance, because other pivots give vectors of other lengths.
void make_room(SparseVectors& vectors) {
  const std::size_t size = vectors.place.size();
  if (vectors.place.capacity() >= size + size / 4) return;
  vectors.place.reserve(2 * size);
  vectors.value.reserve(2 * size);
}

} // namespace

void RowCompliance::set(StageSystem& stages, const std::vector<ForceRow>& rows) {
  stages_ = &stages;
  force_.clear();
  rate_.clear();
  for (const ForceRow& row : rows) {
    stages.append_force(row, force_);
    stages.append_rate(row, rate_);
  }
  make_room(force_);
  make_room(rate_);
  sum_.assign(stages.places(), 0.0);
}

double RowCompliance::between(int i, int j) const {
  std::size_t a = rate_.begin[i], b = force_.begin[j];
  const std::size_t a_end = rate_.begin[i + 1], b_end = force_.begin[j + 1];
  double sum = 0.0;
  while (a < a_end && b < b_end) {
    const int difference = rate_.place[a] - force_.place[b];
    if (difference == 0) sum += rate_.value[a] * force_.value[b];
    if (difference <= 0) ++a;
    if (difference >= 0) ++b;
  }
  return sum;
}

void RowCompliance::apply(const std::vector<double>& forces) {
  std::fill(sum_.begin(), sum_.end(), 0.0);
  for (std::size_t r = 0; r < forces.size(); ++r) add(static_cast<int>(r), forces[r]);
}

void RowCompliance::add(int row, double change) {
  if (change == 0.0) return;
  for (std::size_t e = force_.begin[row]; e < force_.begin[row + 1]; ++e) sum_[force_.place[e]] += force_.value[e] * change;
}

double RowCompliance::rate(int row) const {
  double sum = 0.0;
  for (std::size_t e = rate_.begin[row]; e < rate_.begin[row + 1]; ++e) sum += rate_.value[e] * sum_[rate_.place[e]];
  return sum;
}

} // namespace steplap
