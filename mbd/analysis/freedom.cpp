#include "mbd/analysis/freedom.h"

#include "mbd/math/portable_math.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseQR>

#include <cmath>
#include <map>

namespace steplap {

namespace {

constexpr double k_dependent = 1e-9;

using Matrix = Eigen::SparseMatrix<double>;

// Gradient of a row as a column, bodies without the ground.
void add_column(const RowSpec& row, const std::vector<Motion<double>>& motion, int column,
                std::vector<Eigen::Triplet<double>>& entries) {
  const MeasureValue<double> m = evaluate_row<false>(row, motion.data());
  const Pair<double>& d = m.direction;
  const double gradient[6] = {d.x,  d.y,  cross(m.lever_a, d) + m.couple,
                              -d.x, -d.y, -cross(m.lever_b, d) - m.couple};
  double norm = 0.0;
  for (const double g : gradient)
    norm = portable::hypot(norm, g);
  if (norm == 0.0) return;
  for (int k = 0; k < 6; ++k) {
    const int body = k < 3 ? row.a : row.b;
    if (body != k_ground) entries.emplace_back(3 * (body - 1) + k % 3, column, gradient[k] / norm);
  }
}

using Factor = Eigen::SparseQR<Matrix, Eigen::COLAMDOrdering<int>>;

// Rank of the matrix with these columns; the columns found dependent, in the order of the rows.
int rank_of(const std::vector<const RowSpec*>& rows, const std::vector<Motion<double>>& motion,
            std::vector<int>* dependent) {
  if (rows.empty() || motion.size() < 2) return 0;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < rows.size(); ++i)
    add_column(*rows[i], motion, static_cast<int>(i), entries);
  Matrix matrix(3 * (static_cast<Eigen::Index>(motion.size()) - 1),
                static_cast<Eigen::Index>(rows.size()));
  matrix.setFromTriplets(entries.begin(), entries.end());
  Factor factor;
  factor.setPivotThreshold(k_dependent);
  factor.compute(matrix);
  const auto rank = static_cast<int>(factor.rank());
  if (dependent)
    for (Eigen::Index i = rank; i < matrix.cols(); ++i)
      dependent->push_back(factor.colsPermutation().indices()[i]);
  return rank;
}

// Rows that can be left out without loss, by element: what they carry, others could carry as well.
std::vector<SharedReaction> sharing(const std::vector<const RowSpec*>& rows, std::size_t joint_rows,
                                    const std::vector<int>& elements, const std::vector<Motion<double>>& motion,
                                    int rank) {
  if (rank == static_cast<int>(rows.size())) return {};
  std::map<int, std::vector<std::string>> found;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i >= joint_rows && found.count(elements[i]) > 0) continue;
    std::vector<const RowSpec*> others = rows;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    if (rank_of(others, motion, nullptr) != rank) continue;
    std::vector<std::string>& quantities = found[elements[i]];
    if (i < joint_rows) quantities.emplace_back(rows[i]->quantity);
  }
  std::vector<SharedReaction> result;
  for (auto& [element, quantities] : found) result.push_back({element, std::move(quantities)});
  return result;
}

} // namespace

Freedom count_freedom(const System& system) {
  const State state = system.initial_state();
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  Freedom freedom;
  freedom.coordinates = 3 * (system.body_count() - 1);
  freedom.rows = static_cast<int>(system.rows.size());
  std::vector<const RowSpec*> rows;
  std::vector<int> elements;
  for (const RowSpec& row : system.rows) {
    rows.push_back(&row);
    elements.push_back(row.element);
  }
  freedom.rank = rank_of(rows, motion, &freedom.dependent_rows);
  freedom.shared = sharing(rows, rows.size(), elements, motion, freedom.rank);
  for (const FrictionUnit& unit : system.frictions) {
    if (unit.friction->is_elastic()) continue;
    const RowSpec* first = unit.friction->rows(FrictionState{});
    for (int r = 0; r < unit.friction->dimension(); ++r) {
      rows.push_back(first + r);
      elements.push_back(unit.element);
    }
  }
  freedom.rank_sticking = rank_of(rows, motion, nullptr);
  freedom.shared_sticking = sharing(rows, system.rows.size(), elements, motion, freedom.rank_sticking);
  return freedom;
}

} // namespace steplap
