#include "transformer/decision/criteria.h"

namespace steplap::assess {

namespace {

constexpr const char* k_acceptance_3g = R"toml(# Criteria for a machine that has arrived. Copy, edit, and give your own file instead.
name = "3 g and a core that did not slip"
text = "Energise after ordinary checks only if no axis read more than 3 g, no joint of the core slipped, and what the models ask is met with the probability asked for."
source = "3 g: construction and acceptance code for transformers, clauses 3.3.1 to 3.3.3 (jianbiaoku.com/webarbs/book/27448/883684.shtml); slip: rules of this program"
tests = ["visible damage, and position of the recorder", "dew point and pressure of the gas", "resistance between core and earth"]

[[criterion]]
name = "3 g on every axis"
quantity = "peak"
at_most = "3 gravity"
outcome = "inspect"
text = "All three axes at most 3 g; beyond, transport and unloading are analysed before anybody decides between inspection on site and return. The code names no bandwidth: the peak is that of the record as it was filtered."
source = "construction and acceptance code, clause 3.3.1 to 3.3.3"
tests = ["core to earth, clamp to earth and core to clamp insulation resistance", "internal inspection: positioning parts, upper pressing blocks, lead supports, fasteners"]

[[criterion]]
name = "no joint of the core slips"
quantity = "slip"
outcome = "inspect"
text = "A step-lap joint that slid has lost overlap, whatever the recorder read."
source = "rules of this program"
tests = ["frequency response against the factory's baseline", "no-load loss and current against the factory's", "core to clamp insulation resistance"]

[[criterion]]
name = "no joint comes apart"
quantity = "comes_apart"
outcome = "return"
text = "A corner of the core without overlap cannot be set right on site."
source = "rules of this program"
tests = ["frequency response against the factory's baseline", "internal inspection of the core's corners"]

[[criterion]]
name = "what the models ask"
quantity = "acceptance"
outcome = "inspect"
text = "Reactions, clearances and slides that the models bound by [[acceptance]]; one that says \"reject\" means return."
source = "the models"
tests = ["internal inspection of the parts that the reasons name"]

[[criterion]]
name = "probability of damage"
quantity = "damage_probability"
at_most = 0.05
outcome = "inspect"
text = "Of a joint to slip or an acceptance not to be met, with friction, clamping and damping as uncertain as the models state."
source = "JCSS probabilistic model code: irreversible serviceability, reliability index 1.7, probability 0.05"
tests = ["frequency response against the factory's baseline", "core to clamp insulation resistance"]
)toml";

constexpr const char* k_joints = R"toml(# What the models say alone: no limit on g.
name = "the core did not slip"
text = "Energise after ordinary checks only if no joint of the core slipped and what the models ask is met with the probability asked for. The recorder's peaks decide nothing."
source = "rules of this program; probability: JCSS probabilistic model code, irreversible serviceability"
tests = ["visible damage, and position of the recorder", "dew point and pressure of the gas", "resistance between core and earth"]

[[criterion]]
name = "no joint of the core slips"
quantity = "slip"
outcome = "inspect"
text = "A step-lap joint that slid has lost overlap."
source = "rules of this program"
tests = ["frequency response against the factory's baseline", "no-load loss and current against the factory's", "core to clamp insulation resistance"]

[[criterion]]
name = "no joint comes apart"
quantity = "comes_apart"
outcome = "return"
source = "rules of this program"
tests = ["internal inspection of the core's corners"]

[[criterion]]
name = "what the models ask"
quantity = "acceptance"
outcome = "inspect"
source = "the models"
tests = ["internal inspection of the parts that the reasons name"]

[[criterion]]
name = "probability of damage"
quantity = "damage_probability"
at_most = 0.05
outcome = "inspect"
source = "JCSS probabilistic model code: irreversible serviceability, reliability index 1.7, probability 0.05"
tests = ["frequency response against the factory's baseline", "core to clamp insulation resistance"]
)toml";

constexpr const char* k_peaks_3g = R"toml(# The recorder's peaks alone, as the code has them. It says nothing about a joint.
name = "3 g on every axis"
text = "Energise after ordinary checks if no axis read more than 3 g. What happened inside is not asked."
source = "construction and acceptance code for transformers, clauses 3.3.1 to 3.3.3 (jianbiaoku.com/webarbs/book/27448/883684.shtml)"
tests = ["visible damage, and position of the recorder", "dew point and pressure of the gas", "resistance between core and earth"]

[[criterion]]
name = "3 g on every axis"
quantity = "peak"
at_most = "3 gravity"
outcome = "inspect"
source = "construction and acceptance code, clause 3.3.1 to 3.3.3"
tests = ["core to earth, clamp to earth and core to clamp insulation resistance", "internal inspection: positioning parts, upper pressing blocks, lead supports, fasteners"]
)toml";

} // namespace

const std::vector<CriteriaPreset>& criteria_presets() {
  static const std::vector<CriteriaPreset> presets = {{"acceptance-3g", k_acceptance_3g}, {"joints", k_joints}, {"peaks-3g", k_peaks_3g}};
  return presets;
}

} // namespace steplap::assess
