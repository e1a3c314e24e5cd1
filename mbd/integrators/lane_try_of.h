// For the sources that are compiled for one set of instructions each (lane_try_two.cpp and its like). Nothing is defined here but
// what belongs to one source alone, and nothing of the standard library is called: no other source may come to run code that was
// compiled for instructions which the processor lacks.
#pragma once

#include "mbd/integrators/lane_try_data.h"
#include "mbd/integrators/tableau_dop853.h"

#include <utility>

namespace steplap {

namespace {

template <int lanes>
struct LaneTryOf {
  using Doubles __attribute__((vector_size(8 * lanes))) = double;

  static Doubles load(const double* from) {
    Doubles x;
    __builtin_memcpy(&x, from, sizeof x);
    return x;
  }
  static void store(const Doubles& x, double* to) { __builtin_memcpy(to, &x, sizeof x); }

  // Σ_j w_j k_j over the stages, in their order; what is zero in the table is left out, as in combine() and weighted_sum().
  template <const auto& Weights, std::size_t... J>
  [[gnu::always_inline]] static Doubles sum(const double* k, std::size_t stride, std::index_sequence<J...>) {
    Doubles all{};
    ((Weights[J] != 0.0 ? void(all += Weights[J] * load(k + J * stride)) : void()), ...);
    return all;
  }
  template <std::size_t Row, std::size_t... J>
  [[gnu::always_inline]] static Doubles row_sum(const double* k, std::size_t stride, std::index_sequence<J...>) {
    Doubles all{};
    ((dop853::a[Row][J] != 0.0 ? void(all += dop853::a[Row][J] * load(k + J * stride)) : void()), ...);
    return all;
  }

  template <std::size_t Stage> static unsigned stage(const LaneTryData& d) {
    const auto m = static_cast<std::size_t>(d.coordinates);
    const std::size_t stride = static_cast<std::size_t>(d.rate_rows) * lanes;
    double* const y = d.inputs + (Stage - 1) * static_cast<std::size_t>(d.input_rows) * lanes;
    double* const k = d.rates + Stage * stride;
    const Doubles h = load(d.h);
    for (std::size_t i = 0; i < 2 * m; ++i)
      store(load(d.y0 + i * lanes) + h * row_sum<Stage>(d.rates + i * lanes, stride, std::make_index_sequence<Stage>{}), y + i * lanes);
    for (std::size_t i = 0; i < m; ++i) store(load(y + (m + i) * lanes), k + i * lanes);
    for (int l = 0; l < d.lock_count; ++l)
      store(load(y + (2 * m + 3 * static_cast<std::size_t>(l) + 1) * lanes), k + d.lock_coordinates[l] * lanes);
    return d.code(y, d.constants, k + m * lanes, static_cast<int>(d.looks >> Stage & 1U));
  }

  template <std::size_t... I> static unsigned stages(const LaneTryData& d, std::index_sequence<I...>) {
    unsigned holds = ~0U;
    ((holds = holds != 0 ? holds & stage<I + 1>(d) : 0U), ...);
    return holds;
  }

  static unsigned run(const LaneTryData& d) {
    const unsigned holds = stages(d, std::make_index_sequence<k_lane_stages>{});
    if (holds == 0) return 0;
    const auto n = static_cast<std::size_t>(2 * d.coordinates + 2);
    const std::size_t stride = static_cast<std::size_t>(d.rate_rows) * lanes;
    const auto all = std::make_index_sequence<k_lane_stages + 1>{};
    const Doubles h = load(d.h);
    Doubles fifth{}, third{};
    for (std::size_t i = 0; i < n; ++i) {
      const double* const k = d.rates + i * lanes;
      const Doubles weight = load(d.weight + i * lanes);
      store(load(d.y0 + i * lanes) + h * row_sum<12>(k, stride, all), d.y1 + i * lanes);
      const Doubles of_fifth = sum<dop853::e5>(k, stride, all) * weight, of_third = sum<dop853::e3>(k, stride, all) * weight;
      fifth += of_fifth * of_fifth;
      third += of_third * of_third;
    }
    store(fifth, d.fifth);
    store(third, d.third);
    return holds;
  }
};

} // namespace

} // namespace steplap
