// Elements without a template of their equations, on a tape: what is written down is a call of the functions that evaluate them.
//
// A call takes the motions of the element's bodies, what it adds to, and the time, puts them where an evaluation of doubles would
// find them, and lets the element do what it does there (ForceGroup::add_forces(), or FrictionElement's functions). So one odd
// element costs itself only, and its numbers are those of an evaluation without code, to the bit. What an element remembers
// (modes, friction states, anchors, scratch) is read where the evaluation of the thread has it at the time of the call.
#pragma once

#include "mbd/system/evaluation_arrays.h"

#include <utility>
#include <vector>

namespace steplap {

class ElementCall {
public:
  /// `live` must outlive the call: the evaluation whose modes and memory count. A trace is under way (Traced::start).
  ElementCall(const System& system, const Evaluation& live);
  ElementCall(const ElementCall&) = delete; // the tape's constants point to it
  ElementCall& operator=(const ElementCall&) = delete;

  /// What group.add_forces() does, into `e`.
  void trace(const ForceGroup& group, TracedEvaluation& e);
  /// What FrictionElement::trace_friction() is to do, of friction element f.
  void trace(int f, TracedEvaluation& e, const Traced* rate, Traced* wrench, Traced* watch);

  /// Did the element throw at the last run? Then nothing that was found counts. Forgets it.
  [[nodiscard]] bool has_failed() { return std::exchange(has_failed_, false); }

private:
  struct Constant {
    double* place;
    double value;
  };

  void take(const Traced& x, double& place);
  void take(const Motion<Traced>& from, Motion<double>& to);
  void give(Traced& x, const double& place);
  void add_to(Traced& x, double& place);
  void take_surroundings(const std::vector<char>& is_used, TracedEvaluation& e);
  [[nodiscard]] std::vector<int> slots_of(const std::vector<char>& is_used) const;
  [[nodiscard]] std::vector<std::size_t> contacts_of_group();
  void put_down();
  void evaluate_element();
  static void run(const double* arguments, double* results);

  const System& system_;
  const Evaluation& live_;
  const ForceGroup* group_ = nullptr; ///< null: a friction element
  int friction_ = 0;
  bool is_sliding_ = false;
  Evaluation own_;
  std::vector<Motion<double>> motion_; ///< per slot
  EvaluationArrays arrays_;
  std::vector<double> inner_;
  double rate_[3] = {0, 0, 0}, wrench_[3] = {0, 0, 0};
  std::vector<double*> places_;      ///< of the arguments, behind its own address
  std::vector<Constant> constants_;  ///< what is added to begins with these
  std::vector<const double*> found_; ///< the results
  std::vector<Traced> arguments_;    ///< while it is written down, as `results_`
  std::vector<Traced*> results_;
  bool has_failed_ = false;
};

} // namespace steplap
