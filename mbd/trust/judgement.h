// Verdict on a run: hold, inspect or reject, or open if it cannot be decided. It follows from the criteria of the model ([[acceptance]])
// and from those that some kinds of elements always apply.
//
// A criterion that is not met means inspect or reject, as its consequence says. The verdict is open if a criterion could not be evaluated,
// if the run did not reach its end (reported separately), if the run cannot be trusted (trust.h), or if there are reasons why it cannot
// mean "hold" even if all criteria are met (`caps`).
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Verdicts in order of precedence: the verdict on a run is the last of those that its criteria give.
enum class Verdict { hold, open, inspect, reject };

/// Returns "hold", "open", "inspect" or "reject".
[[nodiscard]] const char* name_of(Verdict verdict);

/// Result of one criterion.
struct CriterionResult {
  std::string name;                       ///< name of the acceptance entry or of the joint
  std::string text;                       ///< requirement as text: "|bottom arresting.force| <= 250000 N"
  std::string reason;                     ///< reason for it or source document; may be empty
  Verdict consequence = Verdict::inspect; ///< verdict if the criterion is not met
  Verdict outcome = Verdict::hold;        ///< verdict that the criterion gives in this run
  std::string where;                      ///< channel or element that has the value
  std::optional<double> value, limit;     ///< the value that exceeds its limit most, or comes nearest to it, and this limit, SI
  std::optional<double> t;                ///< time of that value or event, s
  std::string unit;                       ///< unit of value, limit and reserve
  std::string channel;                    ///< channel whose extreme is the value
  std::optional<double> reserve;          ///< distance to the limit; negative if it is exceeded
  // The following members are set by weigh_errors() (weighed_errors.h).
  std::optional<double> error, t_error; ///< errors of value and t; not-a-number if unknown
  std::string doubt;                    ///< "met, but the error reaches the limit"; empty if there is no doubt
};

/// Verdict on one run with its reasons.
struct Judgement {
  Verdict verdict = Verdict::hold; ///< verdict on the run
  Verdict so_far = Verdict::hold;  ///< verdict on the computed part of the run; differs from `verdict` only if the run stopped early
  bool has_criteria = false;       ///< at least one criterion applied; without any the verdict is open
  std::string distrust;            ///< reason why the run cannot be trusted, and what to try; if not empty, the verdict is open
  std::vector<std::string> caps;   ///< reasons why the run cannot mean "hold": unusual features of the model, or checks that were not made
  std::vector<CriterionResult> criteria; ///< criteria of elements, then of the model, each in the order of the model
};

/// Adds a reason why the verdict cannot be better than "open".
void add_cap(Judgement& judgement, const std::string& why);
/// Sets the verdict to open, because the run cannot be trusted. Does nothing if `why` is empty.
void distrust(Judgement& judgement, const std::string& why);

} // namespace steplap
