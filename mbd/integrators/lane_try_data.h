// What the sources that are compiled for one set of instructions each (lane_try_two.cpp and its like) see of a try in lanes.
#pragma once

namespace steplap {

/// Stages of dop853 behind the first.
inline constexpr int k_lane_stages = 11;

/// Where a try finds its numbers; [row][lane] each. What is compiled for one set of instructions sees nothing else.
struct LaneTryData {
  int coordinates;             ///< m; the packed vector has n = 2m + 2
  int rate_rows;               ///< of one stage in `rates`: n, then watch values and their rates
  int input_rows;              ///< of one stage in `inputs`: 2m, then numbers of time
  int lock_count;
  const int* lock_coordinates; ///< whose rate is the second of the lock's three numbers of time
  unsigned (*code)(const double* inputs, const double* constants, double* outputs, int all);
  unsigned looks;              ///< bit s: of stage s more than the usual outputs is wanted, in some lane
  const double* constants;
  const double* h;             ///< 1 row
  const double *y0, *weight;   ///< n rows
  double* inputs;              ///< k_lane_stages times; numbers of time are there
  double* rates;               ///< k_lane_stages + 1 times; the first is there
  double* y1;                  ///< n rows
  double *fifth, *third;       ///< 1 row: sums of squares of the weighted error estimates
};

/// All stages and what is made of them; bit l: the conditions of the tape held in lane l, which else means nothing. Each for the
/// processors that have what it needs.
unsigned try_in_two_lanes(const LaneTryData& data);   ///< SSE2
unsigned try_in_four_lanes(const LaneTryData& data);  ///< AVX2
unsigned try_in_eight_lanes(const LaneTryData& data); ///< AVX-512 F and DQ

} // namespace steplap
