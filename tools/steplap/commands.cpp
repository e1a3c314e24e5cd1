#include "tools/steplap/commands.h"

namespace steplap {

std::vector<Command> all_commands() {
  std::vector<Command> commands;
  commands.push_back(new_command());
  commands.push_back(simulate_command());
  commands.push_back(explore_command());
  commands.push_back(show_command());
  commands.push_back(report_command());
  commands.push_back(plot_command());
  commands.push_back(record_command());
  commands.push_back(assess_command());
  commands.push_back(cases_command());
  commands.push_back(diff_command());
  commands.push_back(check_command());
  commands.push_back(equilibrium_command());
  commands.push_back(modes_command());
  commands.push_back(joint_command());
  commands.push_back(core_command());
  commands.push_back(accuracy_command());
  commands.push_back(channels_command());
  commands.push_back(elements_command());
  commands.push_back(schema_command());
  commands.push_back(study_command());
  commands.push_back(help_command());
  return commands;
}

} // namespace steplap
