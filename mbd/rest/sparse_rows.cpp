#include "mbd/rest/sparse_rows.h"

#include <algorithm>
#include <cmath>

namespace steplap {

void SparseRows::measure(const Statics& statics, const VecX& scale) {
  measure_all(statics, scale);
  drop_dependent();
}

void SparseRows::measure_and_rank(const Statics& statics, const VecX& scale) {
  measure_all(statics, scale);
  find_dependent(statics);
  drop_dependent();
}

void SparseRows::measure_all(const Statics& statics, const VecX& scale) {
  std::vector<Statics::MatrixEntry> entries;
  statics.gradient(entries);
  rows_.assign(statics.rows().size(), {});
  for (const Statics::MatrixEntry& entry : entries) {
    SparseRow& row = rows_[static_cast<std::size_t>(entry.row())];
    const double value = entry.value() * scale[entry.col()];
    if (statics.rows()[static_cast<std::size_t>(entry.row())].spec->next) row.merge(entry.col(), value);
    else row.add(entry.col(), value);
  }
  size_.resize(static_cast<Eigen::Index>(rows_.size()));
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    double square = 0.0;
    for (int k = 0; k < rows_[r].count; ++k) square += rows_[r].j[k] * rows_[r].j[k];
    const double size = std::max(std::sqrt(square), 1e-300);
    size_[static_cast<Eigen::Index>(r)] = size;
    for (int k = 0; k < rows_[r].count; ++k) rows_[r].j[k] /= size;
  }
}

void SparseRows::find_dependent(const Statics& statics) {
  is_dependent_.assign(rows_.size(), 0);
  if (rows_.empty()) return;
  std::vector<SchurRow> rows(rows_.size());
  std::vector<SchurPart> parts;
  std::vector<int> bodies;
  std::vector<char> is_friction(rows_.size(), 0);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const SparseRow& row = rows_[r];
    is_friction[r] = statics.rows()[r].friction >= 0 ? 1 : 0;
    std::size_t at = r; // index of the present part of the row
    for (int k = 0; k < row.count; ++k) {
      const int side = k / 3 % 2, c = k % 3;
      if (k > 0 && k % 6 == 0) {
        at = rows.size();
        parts.push_back({static_cast<int>(at), static_cast<int>(r)});
        rows.emplace_back();
      }
      rows[at].body[side] = row.at[k] / 3;
      rows[at].w[side][c] = 1.0;
      rows[at].j[side][c] = rows[at].wj[side][c] = row.j[k];
    }
  }
  for (const SchurRow& row : rows) bodies.insert(bodies.end(), row.body, row.body + 2);
  for (const SchurPart& part : parts) bodies.push_back(part.of);
  if (bodies != bodies_) {
    bodies_ = bodies;
    rank_ = {};
    rank_.analyze(rows, static_cast<int>(rows_.size()), parts);
  }
  std::vector<char> was_out(rows_.size(), 0);
  for (std::size_t r = 0; r < rows_.size(); ++r) was_out[r] = rank_.is_left_out(static_cast<int>(r)) ? 1 : 0;
  rank_.decide_rank(is_friction, was_out);
  rank_.factor(rows);
  for (std::size_t r = 0; r < rows_.size(); ++r) is_dependent_[r] = rank_.is_dependent(static_cast<int>(r)) ? 1 : 0;
}

void SparseRows::drop_dependent() {
  for (std::size_t r = 0; r < rows_.size(); ++r)
    if (is_dependent_[r] != 0) rows_[r].count = 0;
}

} // namespace steplap
