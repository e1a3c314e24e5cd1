#include "mbd/integrators/lane_try.h"
#include "mbd/integrators/tableau_dop853.h"

#include <algorithm>

namespace steplap {

namespace {

// Columns of rows; more than there are are kept for the next tape.
void reserve_rows(std::vector<double>& columns, int rows, int lanes) {
  const auto size = static_cast<std::size_t>(rows) * static_cast<std::size_t>(lanes);
  if (columns.size() < size) columns.resize(size);
}

void scatter(const double* from, int count, double* column, int lanes) {
  for (int i = 0; i < count; ++i) column[static_cast<std::size_t>(i) * static_cast<std::size_t>(lanes)] = from[i];
}

} // namespace

void LaneColumns::begin(const StageProgram& program) {
  const MachineCode* const code = program.lane_code();
  if (code == code_) return;
  code_ = code;
  stored_ = program.stored();
  coordinates_ = program.coordinate_count();
  time_rows_ = program.time_count();
  input_rows_ = 2 * coordinates_ + time_rows_;
  rate_rows_ = coordinates_ + program.output_count();
  lock_coordinates_ = program.lock_coordinates();
  const int n = 2 * coordinates_ + 2;
  for (auto* of_packed : {&y0_, &weight_, &y1_}) reserve_rows(*of_packed, n, lanes_);
  for (auto* single : {&h_, &fifth_, &third_}) reserve_rows(*single, 1, lanes_);
  reserve_rows(inputs_, k_lane_stages * input_rows_, lanes_);
  reserve_rows(rates_, (k_lane_stages + 1) * rate_rows_, lanes_);
  reserve_rows(constants_, static_cast<int>(program.constants().size()), lanes_);
  time_.resize(static_cast<std::size_t>(time_rows_));
  loaded_.assign(static_cast<std::size_t>(lanes_), 0);
}

void LaneColumns::load(int lane, const LaneTry::Given& given, Dynamics& dynamics, const StageProgram& program) {
  h_[static_cast<std::size_t>(lane)] = given.h;
  looks_ |= given.looks;
  scatter(given.y0, given.n, y0_.data() + lane, lanes_);
  scatter(given.weight, given.n, weight_.data() + lane, lanes_);
  scatter(given.k0, given.n, rates_.data() + lane, lanes_);
  for (int stage = 1; stage <= k_lane_stages; ++stage) {
    dynamics.stage_time_inputs(program, given.t0 + dop853::c[static_cast<std::size_t>(stage)] * given.h, time_.data());
    double* const rows = inputs_.data() + place(stage - 1, input_rows_, lane);
    scatter(time_.data(), time_rows_, rows + static_cast<std::size_t>(2 * coordinates_) * static_cast<std::size_t>(lanes_), lanes_);
  }
  std::uint64_t& loaded = loaded_[static_cast<std::size_t>(lane)];
  if (loaded == program.tape_number()) return;
  loaded = program.tape_number();
  scatter(program.constants().data(), static_cast<int>(program.constants().size()), constants_.data() + lane, lanes_);
}

unsigned LaneColumns::run() {
  LaneTryData data{};
  data.coordinates = coordinates_;
  data.rate_rows = rate_rows_;
  data.input_rows = input_rows_;
  data.lock_count = static_cast<int>(lock_coordinates_.size());
  data.lock_coordinates = lock_coordinates_.data();
  data.code = code_->entry();
  data.looks = looks_;
  looks_ = 0;
  data.constants = constants_.data();
  data.h = h_.data();
  data.y0 = y0_.data();
  data.weight = weight_.data();
  data.inputs = inputs_.data();
  data.rates = rates_.data();
  data.y1 = y1_.data();
  data.fifth = fifth_.data();
  data.third = third_.data();
  return lanes_ == 8 ? try_in_eight_lanes(data) : lanes_ == 4 ? try_in_four_lanes(data) : try_in_two_lanes(data);
}

} // namespace steplap
