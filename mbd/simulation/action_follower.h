// Executes the actions of a run between its legs, and keeps the model and the systems that result from them.
#pragma once

#include "mbd/simulation/run_leg.h"

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// Action handling of one run; a model with actions has one for each run.
class ActionFollower {
public:
  /// Precondition: `system` contains actions. Elements start active or inactive as the model specifies.
  explicit ActionFollower(const System& system);

  /// Returns the triggers: which actions are armed and due. Shared by all legs.
  [[nodiscard]] ActionTriggers& triggers() { return triggers_; }
  /// Executes the actions that are due at the interruption of `leg`, in the order of the file, and then those that these actions trigger.
  /// Replaces `leg` by the leg in which the run continues. Throws ElementFailure for actions that trigger each other endlessly.
  void act(std::unique_ptr<RunLeg>& leg);
  /// Returns the name of the action that ended the run; empty: none.
  [[nodiscard]] const std::string& ended_by() const { return ended_by_; }
  /// Returns the number of legs that have ended.
  [[nodiscard]] std::size_t past_legs() const { return statistics_.size(); }
  /// Returns the system of `leg` if actions have changed it; null if the leg uses the system in which the run began.
  [[nodiscard]] std::shared_ptr<const System> made_system(const RunLeg& leg) const;
  /// Returns the statistics of all ended legs plus `last`.
  [[nodiscard]] RunStatistics add_statistics(const RunStatistics& last) const;
  /// Returns the channel ranges over all legs. `last`: those of the last leg.
  [[nodiscard]] std::vector<ChannelRange> joined_ranges(std::vector<ChannelRange> last) const;
  /// Returns the travels of contacts beyond their faces in all ended legs.
  [[nodiscard]] const std::vector<FaceTravel>& face_travels() const { return face_travels_; }
  /// Returns the final state of `leg` converted to the system in which the run began.
  [[nodiscard]] State in_first_system(const RunLeg& leg) const;

private:
  /// Difference from the model, as key: which elements are active, and, for each field that was set, the last step that set it.
  struct Arrangement {
    std::vector<char> acts;
    std::map<std::pair<int, std::string>, const ActionStep*> set;
    auto operator<=>(const Arrangement&) const = default;
  };
  struct Arranged {
    std::shared_ptr<System> made; ///< compiled system; null for the first one
    const System* system = nullptr;
    std::vector<char> acts; ///< per element: acts; an element that depends on an inactive one does not
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
  std::map<Arrangement, Arranged> arranged_; ///< systems of all arrangements that have occurred
  std::vector<std::size_t> at_once_;         ///< actions executed at the present time, in order
  std::size_t first_now_ = 0;                ///< index in at_once_ of the first action executed at exactly the present time
  double instant_ = 0.0;                     ///< present time, s
  bool is_ended_ = false;
  std::string ended_by_;
  std::vector<RunStatistics> statistics_;
  std::vector<std::vector<ChannelRange>> ranges_;
  std::vector<FaceTravel> face_travels_;
};

} // namespace steplap
