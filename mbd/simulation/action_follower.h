// Does what the actions of a run say, between its legs: keeps the model as they have made it, and the systems of that.
#pragma once

#include "mbd/simulation/run_leg.h"

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// One per run of a model with actions.
class ActionFollower {
public:
  /// `system` has actions; it begins as its model says.
  explicit ActionFollower(const System& system);

  /// Which actions are armed, for the legs.
  [[nodiscard]] ActionTriggers& triggers() { return triggers_; }
  /// Does what is due where `leg` is interrupted, one after the other in the order of the file, and what is due because of that; puts the
  /// leg in which the run goes on in its place. Throws ElementFailure for actions that set each other off without end.
  void act(std::unique_ptr<RunLeg>& leg);
  /// Of the action that has ended the run; empty: none has.
  [[nodiscard]] const std::string& ended_by() const { return ended_by_; }
  /// Legs that are closed.
  [[nodiscard]] std::size_t past_legs() const { return statistics_.size(); }
  /// The system of `leg`, if it was made for what actions have changed; null: it is the one that the run began in.
  [[nodiscard]] std::shared_ptr<const System> made_system(const RunLeg& leg) const;
  /// Of the legs that are closed.
  [[nodiscard]] RunStatistics add_statistics(const RunStatistics& last) const;
  /// Of all legs, `last` the ranges of the one that the run ended in.
  [[nodiscard]] std::vector<ChannelRange> joined_ranges(std::vector<ChannelRange> last) const;
  /// The final state as the first system has it.
  [[nodiscard]] State in_first_system(const RunLeg& leg) const;

private:
  /// How elements differ from the model: whether they act, and the step of an action that set a field of theirs last.
  struct Arrangement {
    std::vector<char> acts;
    std::map<std::pair<int, std::string>, const ActionStep*> set;
    auto operator<=>(const Arrangement&) const = default;
  };
  struct Arranged {
    std::shared_ptr<System> made; ///< null of the first
    const System* system = nullptr;
    std::vector<char> acts; ///< with what hangs on others
  };
  void happen(std::size_t action, RunLeg& leg);
  void guard_against_rings(std::size_t action, const RunLeg& leg) const;
  void take_step(const ActionStep& step);
  void change_over(std::unique_ptr<RunLeg>& leg, const Arrangement& before);
  [[nodiscard]] const Arranged& arranged(const Arrangement& arrangement);
  [[nodiscard]] std::unique_ptr<System> compiled(const Arrangement& arrangement, std::vector<char>& acts) const;
  [[nodiscard]] Changeover changeover(const Arrangement& before, const Arrangement& after);

  const System& first_;
  const ActionGroup& group_;
  ActionTriggers triggers_;
  Arrangement now_;
  std::map<Arrangement, Arranged> arranged_; ///< so far
  std::vector<std::size_t> at_once_;         ///< actions that have happened at one instant, in their order
  std::size_t first_now_ = 0;                ///< of them, since when no time at all has passed
  double instant_ = 0.0;                     ///< s
  bool is_ended_ = false;
  std::string ended_by_;
  std::vector<RunStatistics> statistics_;
  std::vector<std::vector<ChannelRange>> ranges_;
};

} // namespace steplap
