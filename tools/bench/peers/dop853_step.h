#pragma once

// One DOP853 step for a system of fixed size N: stages, error, dense output.
//
// The coefficients are compile-time data, so that zero entries cost nothing and
// the loops over components are straight line code. The right-hand side is any
// callable f(t, const double* y, double* dydt). Formulas: tableau_dop853.h.

#include "mbd/integrators/tableau_dop853.h"

#include <array>
#include <cmath>
#include <utility>

namespace steplap::peers {

template <int N> class Dop853Step {
public:
  using Vector = std::array<double, N>;

  // Computes the new state y1. Precondition: k[0] contains f(t, y). f(t + h, y1) is not computed.
  template <class F> void advance(F& f, double t, const Vector& y, double h) {
    stages(f, t, y, h, std::make_integer_sequence<int, dop853::k_stages - 1>{});
    combine<12>(y, h, y1);
  }

  // Returns the scaled error of the step. `weight` contains 1/tolerance per component.
  [[nodiscard]] double error(double h, const Vector& weight) const {
    double sum5 = 0.0;
    double sum3 = 0.0;
    for (int i = 0; i < N; ++i) {
      const double e5 = weight[i] * weigh<Weights::e5>(i, std::make_integer_sequence<int, 12>{});
      const double e3 = weight[i] * weigh<Weights::e3>(i, std::make_integer_sequence<int, 12>{});
      sum5 += e5 * e5;
      sum3 += e3 * e3;
    }
    const double scale = sum5 + 0.01 * sum3;
    return scale > 0.0 ? std::abs(h) * sum5 / std::sqrt(scale * N) : 0.0;
  }

  // Prepares the dense output with three further evaluations. Precondition: k[12] contains f(t + h, y1).
  template <class F> void prepare_dense(F& f, double t, const Vector& y, double h) {
    Vector stage;
    combine<13>(y, h, stage);
    f(t + dop853::c[13] * h, stage.data(), k[13].data());
    combine<14>(y, h, stage);
    f(t + dop853::c[14] * h, stage.data(), k[14].data());
    combine<15>(y, h, stage);
    f(t + dop853::c[15] * h, stage.data(), k[15].data());
    for (int i = 0; i < N; ++i) {
      const double rise = y1[i] - y[i];
      r[0][i] = rise;
      r[1][i] = h * k[0][i] - rise;
      r[2][i] = 2.0 * rise - h * (k[0][i] + k[12][i]);
      r[3][i] = h * dense_row<0>(i, std::make_integer_sequence<int, 16>{});
      r[4][i] = h * dense_row<1>(i, std::make_integer_sequence<int, 16>{});
      r[5][i] = h * dense_row<2>(i, std::make_integer_sequence<int, 16>{});
      r[6][i] = h * dense_row<3>(i, std::make_integer_sequence<int, 16>{});
    }
  }

  void dense(const Vector& y, double s, Vector& out) const {
    const double z = 1.0 - s;
    for (int i = 0; i < N; ++i)
      out[i] = y[i] + s * (r[0][i] + z * (r[1][i] + s * (r[2][i] + z * (r[3][i] + s * (r[4][i] + z * (r[5][i] + s * r[6][i]))))));
  }

  alignas(64) std::array<Vector, 16> k;
  alignas(64) Vector y1;

private:
  enum class Weights { e5, e3 };
  alignas(64) std::array<Vector, 7> r;

  template <int S, int... J> [[nodiscard]] double stage_sum(int i, std::integer_sequence<int, J...>) const {
    double sum = dop853::a[S][0] * k[0][i];
    auto add = [&]<int Column>() {
      if constexpr (Column > 0 && dop853::a[S][Column] != 0.0) sum += dop853::a[S][Column] * k[Column][i];
    };
    (add.template operator()<J>(), ...);
    return sum;
  }

  template <int S> void combine(const Vector& y, double h, Vector& out) const {
    constexpr int columns = S;
    for (int i = 0; i < N; ++i) out[i] = y[i] + h * stage_sum<S>(i, std::make_integer_sequence<int, columns>{});
  }

  template <class F, int... J> void stages(F& f, double t, const Vector& y, double h, std::integer_sequence<int, J...>) {
    alignas(64) Vector stage;
    ((combine<J + 1>(y, h, stage), f(t + dop853::c[J + 1] * h, stage.data(), k[J + 1].data())), ...);
  }

  template <Weights W, int... J> [[nodiscard]] double weigh(int i, std::integer_sequence<int, J...>) const {
    constexpr auto& row = W == Weights::e5 ? dop853::e5 : dop853::e3;
    double sum = row[0] * k[0][i];
    auto add = [&]<int Column>() {
      if constexpr (Column > 0 && row[Column] != 0.0) sum += row[Column] * k[Column][i];
    };
    (add.template operator()<J>(), ...);
    return sum;
  }

  template <int Row, int... J> [[nodiscard]] double dense_row(int i, std::integer_sequence<int, J...>) const {
    double sum = dop853::d[Row][0] * k[0][i];
    auto add = [&]<int Column>() {
      if constexpr (Column > 0 && dop853::d[Row][Column] != 0.0) sum += dop853::d[Row][Column] * k[Column][i];
    };
    (add.template operator()<J>(), ...);
    return sum;
  }
};

} // namespace steplap::peers
