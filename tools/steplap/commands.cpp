#include "tools/steplap/commands.h"

#include "tools/steplap/accuracy.h"
#include "tools/steplap/assess.h"
#include "tools/steplap/cases.h"
#include "tools/steplap/channels.h"
#include "tools/steplap/check.h"
#include "tools/steplap/core.h"
#include "tools/steplap/diff.h"
#include "tools/steplap/elements.h"
#include "tools/steplap/equilibrium.h"
#include "tools/steplap/explore.h"
#include "tools/steplap/help.h"
#include "tools/steplap/joint.h"
#include "tools/steplap/modes.h"
#include "tools/steplap/new.h"
#include "tools/steplap/plot.h"
#include "tools/steplap/record.h"
#include "tools/steplap/report.h"
#include "tools/steplap/schema.h"
#include "tools/steplap/show.h"
#include "tools/steplap/simulate.h"
#include "tools/steplap/study.h"

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
