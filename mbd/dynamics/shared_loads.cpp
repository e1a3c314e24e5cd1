// Dynamics with dependent constraints: event functions of sticking groups, and the choice of the reported load distribution
// (load_sharing.h).
#include "mbd/dynamics/dynamics.h"

#include <algorithm>
#include <utility>

namespace steplap {

// Computes the null vectors at the present pose, unless the known ones are still valid.
void Dynamics::find_sharing() {
  Layout& layout = *layout_;
  const std::vector<Motion<double>>& all = motion();
  std::vector<char> left_out(system_.friction_row_count, 0);
  for (const HeldRow& held : layout.held_rows) left_out[held.friction_row] = layout.is_dependent(held.row) ? 1 : 0;
  if (layout.sharing && layout.sharing->holds_at(all, left_out)) return;
  layout.sharing = std::make_unique<LoadSharing>(system_, *state_, all, std::move(left_out));
  if (layout.sharing->has_friction()) layout.has_rigid_joint_events = true;
}

const LoadSharing* Dynamics::sharing_now() const {
  const Layout& layout = *layout_;
  // Pending by-products belong to an evaluation by code, which is used only if no rows depend on each other.
  return !pending_.is_pending() && layout.is_singular() ? layout.sharing.get() : nullptr;
}

bool Dynamics::is_shared(int friction) const {
  const LoadSharing* const shared = sharing();
  return shared && shared->group_of(friction) >= 0;
}

// Restores the friction forces of the solution in the array, which may contain a reported distribution instead.
void Dynamics::store_solved_friction() {
  for (std::size_t r = 0; r < layout_->active.size(); ++r) {
    const ActiveRow& row = layout_->active[r];
    if (row.friction >= 0) friction_force_[system_.frictions[row.friction].row + row.friction_row] = multipliers()[r];
  }
}

// Sets the event functions of each group, in the slots of all its elements. First: 1 minus the least utilisation; when it becomes negative
// the group slips, and the mode problem decides which elements do. Second: 1 minus the incompatible motion of its rows
// (LoadSharing::discord). Returns true if one of them is near zero. Precondition: wrenches of joints inside clusters are computed.
bool Dynamics::evaluate_group_events() {
  bool is_near = false;
  if (!sharing()) return is_near;
  find_sharing();
  layout_->sharing->solve(evaluation_, friction_force_);
  const std::vector<SharingGroup>& groups = layout_->sharing->groups();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const SharingGroup& group = groups[g];
    const double margin = 1.0 + k_bound_slack - group.least.usage();
    const double concord = 1.0 - layout_->sharing->discord(static_cast<int>(g), evaluation_, reactions_.acceleration().data());
    for (const int f : group.frictions) {
      arrays_.event_value[system_.frictions[f].slot(FrictionWatch::first)] = margin;
      arrays_.event_value[system_.frictions[f].slot(FrictionWatch::second)] = concord;
    }
    if (concord < k_near_limit) is_near = true;
    if (margin < k_near_limit) is_near = true;
  }
  return is_near;
}

void Dynamics::settle_loads() {
  const Layout& layout = *layout_;
  if (!layout.is_singular() && layout.redundant_blocks.empty()) return;
  for (const int i : layout.redundant_blocks) {
    const RowBlock& block = system_.row_blocks[i];
    std::fill_n(&reactions_.row_force()[block.first], block.count, 0.0);
  }
  find_sharing();
  layout_->sharing->solve(evaluation_, friction_force_);
  layout_->sharing->settle(reactions_.row_force().data(), friction_force_);
}

} // namespace steplap
