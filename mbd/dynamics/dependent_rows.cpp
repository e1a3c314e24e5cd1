#include "mbd/dynamics/dependent_rows.h"

#include "mbd/dynamics/schur.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_stays_out = 2.0; // factor on k_dependent for a row that was left out before

// Orthonormal basis of the rows kept so far. Each vector is the normalised part of a row that is independent of the rows before it.
class RowBasis {
public:
  RowBasis(Eigen::Index dimension, Eigen::Index most) : basis_(dimension, std::min(dimension, most)) {}
  void remove_from(VecX& row) const {
    const auto taken = basis_.leftCols(count_);
    for (int pass = 0; pass < 2; ++pass) row -= taken * (taken.transpose() * row); // the second pass removes rounding of the first
  }
  // Adds a row that is orthogonal to the basis. Returns false if the basis spans the space already.
  bool take(const VecX& row) {
    if (count_ == basis_.cols()) return false;
    basis_.col(count_++) = row.normalized();
    return true;
  }

private:
  MatX basis_;
  Eigen::Index count_ = 0;
};

struct Candidate {
  std::size_t row;
  double length, allowed; // `allowed`: fraction of the length
  VecX beyond;
};

} // namespace

std::vector<char> dependent_rows(const std::vector<WeightedRow>& rows, const char* can_stay_out, const std::vector<char>& was_out) {
  std::vector<char> out(rows.size(), 0);
  if (rows.empty()) return out;
  RowBasis taken(rows[0].row.size(), static_cast<Eigen::Index>(rows.size()));
  std::vector<Candidate> candidates;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double length = rows[r].length;
    if (can_stay_out[r] != 0) {
      out[r] = 1;
      const bool was = !was_out.empty() && was_out[r] != 0;
      const double allowed = was ? k_stays_out * SchurSolver::k_dependent : SchurSolver::k_dependent;
      if (length > 0.0) candidates.push_back({r, length, allowed, rows[r].row});
      continue;
    }
    VecX row = rows[r].row;
    taken.remove_from(row);
    if (row.norm() > std::sqrt(SchurSolver::k_pivot_tolerance) * length) taken.take(row);
  }
  for (Candidate& c : candidates) taken.remove_from(c.beyond);
  while (!candidates.empty()) {
    const auto farthest = std::max_element(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      return a.beyond.norm() / (a.allowed * a.length) < b.beyond.norm() / (b.allowed * b.length);
    });
    if (!(farthest->beyond.norm() > farthest->allowed * farthest->length) || !taken.take(farthest->beyond)) break;
    out[farthest->row] = 0;
    candidates.erase(farthest);
    for (Candidate& c : candidates) taken.remove_from(c.beyond);
  }
  return out;
}

} // namespace steplap
