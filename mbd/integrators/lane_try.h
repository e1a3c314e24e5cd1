// A try of a step of dop853 that is made beside tries of other samples, in the lanes of a register (mbd/ensemble).
//
// Samples whose stages are one tape (mbd/dynamics/stage_program.h) make the same operations on other numbers. Of a try these are all
// twelve stages, their sums and both error norms: LaneColumns keeps them as [number][lane] and makes the try, in the order and with
// the bits of Dop853::try_step. Watch values and merged joints are the sample's own again (LaneTry::take).
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/integrators/lane_try_data.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace steplap {

class LaneColumns;

/// The try of a step that is due, of one sample.
class LaneTry {
public:
  struct Given {
    double t0, h;
    int n;                ///< length of the packed vector
    const double* y0;     ///< n
    const double* k0;     ///< n, rates at t0
    const double* weight; ///< n, of the error norm
    unsigned looks;       ///< bit s: merged joints are looked at after stage s
  };
  [[nodiscard]] virtual Given given(const Dynamics& dynamics) = 0;
  /// Takes over what was made in this lane, as if it had made the try itself. std::logic_error if a stage that is evaluated
  /// as well has other bits.
  virtual void take(Dynamics& dynamics, const LaneColumns& made, int lane) = 0;

protected:
  ~LaneTry() = default;
};

/// Tries side by side.
class LaneColumns {
public:
  explicit LaneColumns(int lanes) : lanes_(lanes) {}
  [[nodiscard]] int lanes() const { return lanes_; }

  /// The tries that follow are of this tape.
  void begin(const StageProgram& program);
  /// Preconditions: begin() was called with a program of the same tape; program.lane_code(lanes()) is not null.
  void load(int lane, const LaneTry::Given& given, Dynamics& dynamics, const StageProgram& program);
  /// Bit l: the try in lane l is right. Lanes that were not loaded mean nothing. Then all are empty again.
  [[nodiscard]] unsigned run();

  // --- of a try that is right, stages 1 … k_lane_stages; each number lanes() places from the one before -------------------
  /// Rates of the packed vector.
  [[nodiscard]] const double* rates(int stage, int lane) const { return rates_.data() + place(stage, rate_rows_, lane); }
  [[nodiscard]] StageColumn stage(int stage, int lane) const {
    return {inputs_.data() + place(stage - 1, input_rows_, lane),
            rates(stage, lane) + static_cast<std::size_t>(coordinates_) * static_cast<std::size_t>(lanes_), lanes_};
  }
  [[nodiscard]] const double* end(int lane) const { return y1_.data() + lane; }
  [[nodiscard]] double fifth(int lane) const { return fifth_[static_cast<std::size_t>(lane)]; }
  [[nodiscard]] double third(int lane) const { return third_[static_cast<std::size_t>(lane)]; }

private:
  [[nodiscard]] std::size_t place(int stage, int rows, int lane) const {
    return static_cast<std::size_t>(stage) * static_cast<std::size_t>(rows) * static_cast<std::size_t>(lanes_) +
           static_cast<std::size_t>(lane);
  }

  int lanes_;
  int coordinates_ = 0, rate_rows_ = 0, input_rows_ = 0, time_rows_ = 0;
  std::shared_ptr<StoredCode> stored_; ///< whose code it is: the address is no other's as long as it is kept
  const MachineCode* code_ = nullptr;
  unsigned looks_ = 0;
  std::vector<int> lock_coordinates_;
  std::vector<double> y0_, weight_, h_, inputs_, rates_, y1_, fifth_, third_, constants_, time_;
  std::vector<std::uint64_t> loaded_; ///< per lane: the tape whose constants are there
};

} // namespace steplap
