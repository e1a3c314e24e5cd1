// Triangular decompositions: Cholesky, LDLᵀ and LU.
#include "mbd/base/decompositions.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <limits>

namespace steplap {

MatX solve_lower(const MatX& a, const MatX& right) { return a.llt().matrixL().solve(right); }

VecX solve_symmetric(const MatX& a, const VecX& right) { return a.ldlt().solve(right); }
MatX solve_symmetric(const MatX& a, const MatX& right) { return a.ldlt().solve(right); }

struct DenseLu::Factor : Eigen::PartialPivLU<MatX> {
  using PartialPivLU::PartialPivLU;
};

DenseLu::DenseLu() : factor_(std::make_unique<Factor>()) {}
DenseLu::DenseLu(const MatX& a) : DenseLu() { factor(a); }
DenseLu::~DenseLu() = default;
DenseLu::DenseLu(DenseLu&&) noexcept = default;
DenseLu& DenseLu::operator=(DenseLu&&) noexcept = default;

void DenseLu::factor(const MatX& a) { factor_->compute(a); }
double DenseLu::least_pivot() const {
  const auto& lu = factor_->matrixLU();
  return lu.size() > 0 ? lu.diagonal().cwiseAbs().minCoeff() : std::numeric_limits<double>::infinity();
}
void DenseLu::solve(const VecX& right, VecX& x) const { x.noalias() = factor_->solve(right); }
VecX DenseLu::solve(const VecX& right) const { return factor_->solve(right); }
VecX DenseLu::solve_transposed(const VecX& right) const { return factor_->transpose().solve(right); }

struct RankLu::Factor : Eigen::FullPivLU<MatX> {
  using FullPivLU::FullPivLU;
};

RankLu::RankLu(const MatX& a) : factor_(std::make_unique<Factor>(a)) {}
RankLu::~RankLu() = default;
MatX RankLu::solve(const MatX& right) const { return factor_->solve(right); }

} // namespace steplap
