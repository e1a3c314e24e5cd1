// Elements whose laws are not templates, on a tape: the tape contains a call of the element's own function for doubles.
//
// The call copies the motions of the element's bodies, the sums to which the element adds, and the time to the arrays of an Evaluation, and
// calls ForceGroup::add_forces() or the functions of FrictionElement. One such element therefore does not prevent machine code for the rest
// of the model, and results are bit-identical to those without code. Modes, friction states, anchors and caches are read from the thread's
// current evaluation.
#pragma once

#include "mbd/system/evaluation_arrays.h"

#include <utility>
#include <vector>

namespace steplap {

/// A recorded call of one friction element, or of one force group.
class ElementCall {
public:
  /// Precondition: recording has been started (TapeNumber::start). `live`: the evaluation whose modes and caches the call reads; it must
  /// outlive this object.
  ElementCall(const System& system, const Evaluation& live);
  ElementCall(const ElementCall&) = delete; // the tape's constants point to it
  ElementCall& operator=(const ElementCall&) = delete;

  /// Records a call of group.add_forces() that adds to `e`.
  void trace(const ForceGroup& group, TracedEvaluation& e);
  /// Records FrictionElement::record_friction() for friction element f.
  void trace(int f, TracedEvaluation& e, const TapeNumber* rate, TapeNumber* wrench, TapeNumber* event_value);

  /// Returns true if the element threw an exception since the last call of has_failed(). The results of the tape are then invalid.
  [[nodiscard]] bool has_failed() { return std::exchange(has_failed_, false); }

private:
  struct Constant {
    double* place;
    double value;
  };

  void take(const TapeNumber& x, double& place);
  void take(const Motion<TapeNumber>& from, Motion<double>& to);
  void give(TapeNumber& x, const double& place);
  void add_to(TapeNumber& x, double& place);
  void record_surroundings(const std::vector<char>& is_used, TracedEvaluation& e);
  [[nodiscard]] std::vector<int> slots_of(const std::vector<char>& is_used) const;
  [[nodiscard]] std::vector<std::size_t> contacts_of_group();
  void put_down();
  void evaluate_element();
  static void run(const double* arguments, double* results);

  const System& system_;
  const Evaluation& live_;
  const ForceGroup* group_ = nullptr; ///< null: the call is that of a friction element
  int friction_ = 0;
  bool is_sliding_ = false;
  Evaluation own_;
  std::vector<Motion<double>> motion_; ///< per slot
  EvaluationArrays arrays_;
  std::vector<double> inner_;
  double rate_[3] = {0, 0, 0}, wrench_[3] = {0, 0, 0};
  std::vector<double*> places_;       ///< addresses of the arguments; the first argument of the call is the address of this object
  std::vector<Constant> constants_;   ///< initial values of the sums that are constants
  std::vector<const double*> found_;  ///< addresses of the results
  std::vector<TapeNumber> arguments_; ///< used only while recording, like `results_`
  std::vector<TapeNumber*> results_;
  bool has_failed_ = false;
};

} // namespace steplap
