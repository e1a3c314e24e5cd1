#include "tools/steplap/assess.h"

#include "tools/steplap/commands.h"
#include "tools/steplap/static_proof.h"

#include <algorithm>

namespace steplap {

namespace {

// Throws for an option that concerns records: a static proof has none, and would ignore it.
void refuse_record_options(const AssessOptions& o) {
  const std::pair<const char*, bool> all[] = {{"--second", !o.second_records.empty()}, {"--voyage", o.voyage.has_value()},
                                              {"--shipment", o.shipment.has_value()},  {"--accept", !o.accepted.empty()},
                                              {"--criteria", o.criteria.has_value()},  {"--samples", o.samples.has_value()},
                                              {"--seed", o.seed.has_value()},          {"--budget", o.budget.has_value()},
                                              {"--pulse", o.pulse.has_value()},        {"--pulse-axis", o.pulse_axis.has_value()}};
  for (const auto& [name, is_given] : all)
    if (is_given) throw UsageError(std::string(name) + " is of no use with --static, which reads no record: leave it out");
}

ExitCode assess_here(const AssessOptions& options, Console& console) {
  if (!options.static_preset) throw UsageError("assessments are made by the program of studies: begin with 'steplap assess'");
  refuse_record_options(options);
  StaticProofArguments arguments;
  arguments.models = options.records; // with --static the positional arguments are models, not records
  arguments.models.insert(arguments.models.end(), options.models.begin(), options.models.end());
  if (arguments.models.empty()) throw UsageError("--static: name the models, as in 'steplap assess --static road my.toml'");
  arguments.overrides = options.overrides;
  arguments.preset = options.static_preset;
  arguments.plane = options.plane;
  arguments.directions = options.directions;
  arguments.largest = options.largest;
  arguments.output = options.output;
  arguments.is_overwriting = options.is_overwriting;
  arguments.is_json = options.is_json;
  return prove_statically(arguments, console);
}

} // namespace

bool is_record_assessment(const std::vector<std::string>& arguments) {
  const auto command = std::find_if(arguments.begin(), arguments.end(), [](const std::string& word) { return !word.starts_with('-'); });
  if (command == arguments.end() || *command != "assess") return false;
  return std::none_of(arguments.begin(), arguments.end(), [](const std::string& word) {
    return word == "--static" || word.starts_with("--static=") || word == "--help" || word == "-h";
  });
}

Command assess_command(const std::function<ExitCode(const AssessOptions& options, Console& console)>& work) {
  const auto o = std::make_shared<AssessOptions>();
  Command command;
  command.name = "assess";
  command.summary = "from a shock recorder's file and models to a decision: energise, inspect or return";
  command.examples =
      R"(  steplap assess shock.csv --model models/assess/transformer.toml --gravity z --voyage "2016-01-04 10:00, 2016-01-06 18:00" -o out/arrival
  steplap assess first.csv second.csv --model lengthwise.toml --model crosswise.toml --criteria mine.toml
  steplap assess --print-criteria acceptance-3g > mine.toml
  steplap assess --static road --plane lengthwise models/paper/interference.toml -o out/road
Every event of the records goes through every model, in order of time, from where the one before left the machine; DIR/assessment.json
holds all of it. Exit codes of a decision: 0 energise, 10 inspect, 11 return, 12 open (what is needed to decide is not known). An
assessment that is interrupted goes on when it is asked for again. See docs/how-to/assess_a_transport.md.
Of a static proof (docs/how-to/prove_statically.md): 0 the machine is proven to hold, 5 it is not, 4 the verdict is open, or nothing could be computed.
)";
  command.options = {
      {"RECORD", &o->records, "RECORD", "recorders' files, each with what its own --gravity and the like say; with --static: models"},
      {"-m,--model", &o->models, "MODEL", "model with a [[recorder]]; one for each plane"},
      {"-o,--output", &o->output, "DIR",
       "folder of assessment.json (default: out/assessment); with --static, of static.json (default: none is written)"},
      {"--criteria", &o->criteria, "FILE|PRESET", "what decides: a file, or acceptance-3g (default), joints, peaks-3g"},
      {"--print-criteria", &o->print_criteria, "PRESET", "print a preset, to be edited"},
      {"--set", &o->overrides, "PATH=VALUE", "lay a value over every model; may be repeated"},
      {"--samples", &o->samples, "N", "voyages with other values of what is uncertain (default: 200); 0: none, and no probability"},
      {"--seed", &o->seed, "N", "of the samples (default: 1)"},
      {"--threads", &o->threads, "N", "of the samples (default: all processors); results are the same for any number"},
      {"--voyage", &o->voyage, "FROM,TO",
       "when the journey began and ended: two dates with times of day, or seconds of the record. Less covered than that is open"},
      {"--shipment", &o->shipment, "FILE",
       "serial numbers, departure, handovers, arrival and recorders, for the sheet that is signed; departure and arrival are the voyage"},
      {"--second", &o->second_records, "FILE",
       "record of a second recorder on the same machine, read like the first; may be repeated. The less favourable decision counts"},
      {"--accept", &o->accepted, "EVIDENCE",
       "decide although it is missing: clipped, gaps, peaks, cut, comments, fall, dead, unit, axis, coverage, clock, bandwidth, place, "
       "vibration or planes; may be repeated"},
      {"--budget", &o->budget, "S", "computing time, for each day of record, to find how low the threshold has to be: 60"},
      {"--pulse", &o->pulse, "SHAPE",
       "of lists of peaks without waveforms: drive the models by a half-sine, haversine or triangle; \"half-sine 50 ms\" where the list "
       "states no duration. The decision is open unless --accept peaks"},
      {"--pulse-axis", &o->pulse_axis, "AXIS", "x, y or z: direction of peaks whose list states none"},
      {"--no-estimate", &o->is_estimate_left_out, "", "do not estimate errors of the runs"},
      {"--static", &o->static_preset, "PRESET", "constant loads instead of records: iec-1g, road, sea, or a file of your own (.toml)"},
      {"--plane", &o->plane, "PLANE",
       "with --static: lengthwise (default where it makes no difference) or transverse, the section that the models show"},
      {"--directions", &o->directions, "N", "with --static: directions in which a pull grows until something gives way: 72"},
      {"--largest", &o->largest, "A", "with --static: how far it grows, m/s^2: 98.1"},
      {"--json", &o->is_json, "", "print assessment.json instead of the screen"},
      {"-f,--force", &o->is_overwriting, "", "overwrite an earlier assessment"}};
  const std::vector<Option> reading = reading_options(*o);
  command.options.insert(command.options.end(), reading.begin(), reading.end());
  command.run = [o, work](Console& console) { return work(*o, console); };
  return command;
}

Command assess_command() { return assess_command(assess_here); }

} // namespace steplap
