// Hold, inspect or reject: what a run is worth by the criteria of its model ([[acceptance]]) and by those that elements of some
// kinds are always held to.
//
// What is not met means inspect or reject, by its consequence. A criterion that could not be evaluated is not met: it leaves
// the verdict open. So does a run that did not reach its end, whatever came before; that is told beside it. And so does one that
// is not to be trusted (trust.h), or that cannot mean "hold" whatever it meets: its caps.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// In the order of how much they weigh: the verdict is the largest over all criteria.
enum class Verdict { hold, open, inspect, reject };

/// "hold", "open", "inspect" or "reject".
[[nodiscard]] const char* name_of(Verdict verdict);

/// What became of one criterion.
struct CriterionResult {
  std::string name;                       ///< of the acceptance entry, or of the joint
  std::string text;                       ///< what is asked: "|bottom arresting.force| <= 250000 N"
  std::string reason;                     ///< why it is asked, or by which document; may be empty
  Verdict consequence = Verdict::inspect; ///< if it is not met
  Verdict outcome = Verdict::hold;        ///< what it means for the verdict
  std::string where;                      ///< channel or element of the value
  std::optional<double> value, limit;     ///< the value nearest to or furthest beyond its limit, SI
  std::optional<double> t;                ///< s, of that value or event
  std::string unit;                       ///< of value, limit and reserve
  std::string channel;                    ///< whose extreme the value is
  std::optional<double> reserve;          ///< how far inside its limit the value is; negative: beyond
  // Filled in by weigh_errors (weighed_errors.h):
  std::optional<double> error, t_error; ///< of value and t; not-a-number: unknown
  std::string doubt;                    ///< "met, but the error reaches the limit"; empty: none
};

/// The verdict on one run with all that it was made of.
struct Judgement {
  Verdict verdict = Verdict::hold; ///< on the run
  Verdict so_far = Verdict::hold;  ///< of what was computed: the verdict itself, but for a run that broke off
  bool has_criteria = false;       ///< anything was asked of the run; where nothing was, the verdict is open
  std::string distrust;            ///< not empty: why the run itself is not to be trusted, and what to try; its verdict is then open
  std::vector<std::string> caps; ///< why the run cannot mean "hold", whatever it meets: what is unusual in the model, what it was not asked
  std::vector<CriterionResult> criteria; ///< elements' first, then the model's, each in the order of the model
};

/// The verdict is "open" at best from now on. No reason to inspect a machine, and none to sign that it holds.
void add_cap(Judgement& judgement, const std::string& why);
/// The run is not to be trusted: its verdict is open. Nothing if `why` is empty.
void distrust(Judgement& judgement, const std::string& why);

} // namespace steplap
