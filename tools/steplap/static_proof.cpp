#include "tools/steplap/static_proof.h"

#include "mbd/base/shown_text.h"
#include "mbd/io/atomic_file.h"
#include "mbd/io/input_files.h"
#include "mbd/run/quantity_text.h"
#include "tools/assess/static_json.h"
#include "tools/steplap/interruption.h"
#include "tools/steplap/log.h"
#include "tools/steplap/text_table.h"
#include "transformer/program.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <utility>

namespace steplap {

namespace {

using namespace assess;
using Align = TextTable::Align;

constexpr int k_most_directions = 3600;
constexpr double k_most_acceleration = 1e4; // upper limit for --largest, m/s²
constexpr double k_unloaded = 1e6;          // a load margin above this means that the load is only rounding
constexpr double k_least_share = 1e-9;      // smaller utilisations of a reaction's limit are not shown
constexpr std::size_t k_most_feet = 2;      // number of feet named in one row; others are counted

double number_of(const std::string& text, const std::string& option, double low, double high) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || last != end || !(value >= low && value <= high))
    throw UsageError(option + " takes a number from " + rounded_text(low) + " to " + rounded_text(high) + ", not '" + text + "'");
  return value;
}

StaticProofOptions options_of(const StaticProofArguments& arguments, const StaticPreset& preset) {
  StaticProofOptions options;
  options.stop = interruption;
  if (arguments.plane && *arguments.plane != "lengthwise" && *arguments.plane != "transverse")
    throw UsageError("--plane '" + *arguments.plane + "': give lengthwise or transverse");
  if (!arguments.plane && depends_on_plane(preset))
    throw UsageError("the loads of '" + preset.name +
                     "' differ between the planes: say which one the models show, with --plane lengthwise or --plane transverse");
  if (arguments.plane == "transverse") options.plane = Plane::transverse;
  if (arguments.directions) {
    const double count = number_of(*arguments.directions, "--directions", 0, k_most_directions);
    if (count != std::floor(count)) throw UsageError("--directions takes a whole number, not '" + *arguments.directions + "'");
    options.directions = static_cast<int>(count);
  }
  if (arguments.largest) options.largest = number_of(*arguments.largest, "--largest", 1e-3, k_most_acceleration);
  return options;
}

// Shows four digits; files contain all.
std::string acceleration_text(double a) { return rounded_text(a, 4) + " m/s²"; }

std::string margin_text(const StaticCase& one) {
  if (one.joints.empty()) return "-";
  double least = INFINITY;
  for (const StaticJoint& joint : one.joints)
    if (!(joint.margin >= least)) least = joint.margin;
  return least > k_unloaded ? "no load" : rounded_text(least, 4);
}

std::string feet_text(const StaticCase& one) {
  std::string text;
  std::size_t count = 0;
  for (const StaticFoot& foot : one.feet)
    if (foot.lifts && ++count <= k_most_feet) text += (text.empty() ? "" : ", ") + foot.name;
  if (count > k_most_feet) text += " and " + std::to_string(count - k_most_feet) + " more";
  return text.empty() ? "-" : text;
}

// Returns the reaction with the highest utilisation.
std::string reaction_text(const StaticCase& one) {
  const StaticReaction* nearest = nullptr;
  const auto share = [](const StaticReaction& r) { return std::abs(r.value) / *r.allowed; };
  for (const StaticReaction& reaction : one.reactions)
    if (reaction.allowed && *reaction.allowed > 0.0 && (!nearest || share(reaction) > share(*nearest))) nearest = &reaction;
  return nearest && share(*nearest) > k_least_share ? rounded_text(100.0 * share(*nearest), 3) + " % " + nearest->name : "-";
}

void print_cases(std::ostream& out, const StaticProof& proof) {
  TextTable table({Align::left, Align::right, Align::left, Align::right, Align::left, Align::left, Align::left});
  table.add_row({"case", "pull, m/s²", "verdict", "least margin", "reaction, of allowed", "feet that lift", "first, while the pull grows"});
  for (const StaticCase& one : proof.cases)
    table.add_row({one.load.name, rounded_text(one.load.pull.x(), 4) + ", " + rounded_text(one.load.pull.y(), 4),
                   steplap::name_of(one.verdict), margin_text(one), reaction_text(one), feet_text(one),
                   one.first.empty() ? "-" : one.first});
  out << table;
  for (const StaticCase& one : proof.cases)
    if (one.verdict != Verdict::hold) out << "  " << steplap::name_of(one.verdict) << ", " << one.load.name << ": " << one.why << "\n";
    else if (!one.slid.empty())
      out << "  " << one.load.name << ": '" << one.slid.front() << "' slides, and the machine comes to rest "
          << rounded_text(1e3 * one.moved, 3) << " mm away\n";
}

// Prints, for each kind of limit, the direction of the acceleration that reaches it first.
void print_weakest(std::ostream& out, const StaticProof& proof) {
  if (proof.polar.empty()) return;
  TextTable table({Align::left, Align::right, Align::right, Align::right});
  bool is_any = false;
  for (const LimitKind kind : {LimitKind::slips, LimitKind::slides, LimitKind::lifts, LimitKind::breaks, LimitKind::ends}) {
    const StaticDirection* weakest = nullptr;
    std::size_t which = 0;
    for (const StaticDirection& direction : proof.polar)
      for (std::size_t i = 0; i < direction.ray.limits.size(); ++i) {
        const StaticLimit& limit = direction.ray.limits[i];
        if (limit.kind != kind || (weakest && limit.acceleration >= weakest->ray.limits[which].acceleration)) continue;
        weakest = &direction;
        which = i;
      }
    if (!weakest) continue;
    const StaticLimit& limit = weakest->ray.limits[which];
    if (!std::exchange(is_any, true)) table.add_row({"weakest direction", "towards", "pull", "error"});
    table.add_row({limit_text(weakest->ray, which), rounded_text(weakest->angle * 57.29577951308232, 4) + "°",
                   acceleration_text(limit.acceleration), small_text(limit.error) + " m/s²"});
  }
  if (is_any) out << "\n" << table;
  else
    out << "\n  Nothing gives way up to " << acceleration_text(proof.largest) << " in "
        << counted(proof.polar.size(), "direction", "directions") << ".\n";
  const auto open = std::count_if(proof.polar.begin(), proof.polar.end(), [](const StaticDirection& d) { return !d.is_unique; });
  if (open > 0)
    out << "  In " << counted(static_cast<std::size_t>(open), "direction", "directions") << " of " << proof.polar.size()
        << " the first limit depends on the history.\n";
}

void print_proof(std::ostream& out, const StaticProof& proof) {
  out << proof.model << ", " << name_of(proof.plane) << ", " << proof.preset.name << ": " << steplap::name_of(proof.verdict) << "\n  "
      << proof.reason << "\n  Loads: " << proof.preset.source << "\n\n";
  print_cases(out, proof);
  print_weakest(out, proof);
  if (!proof.unasked.empty()) {
    out << "  Not asked, since a rest cannot answer it:";
    for (const std::string& name : proof.unasked) out << " '" << name << "'";
    out << "\n";
  }
}

} // namespace

ExitCode prove_statically(const StaticProofArguments& arguments, Console& console) {
  StaticPreset preset;
  StaticProofOptions options;
  try {
    preset = static_preset(*arguments.preset);
    options = options_of(arguments, preset);
    static_cast<void>(loads_for(preset, options.plane));
  } catch (const std::invalid_argument& wrong) {
    throw UsageError(std::string("--static: ") + wrong.what());
  }
  const std::string file = arguments.output ? (std::filesystem::path(*arguments.output) / "static.json").string() : "";
  if (arguments.output && !arguments.is_overwriting && std::filesystem::exists(file))
    throw UsageError("'" + file + "' exists: choose another folder, or overwrite it with --force");
  const InterruptionGuard guard;
  std::vector<StaticProof> proofs;
  std::vector<std::string> digests;
  ExitCode code = ExitCode::done;
  for (const auto& loaded : load_models(arguments.models, arguments.overrides)) {
    try {
      proofs.push_back(assess::prove_statically(*loaded, preset, options));
      digests.push_back(loaded->inputs.front().sha256); // the model itself is read first
    } catch (const NumericalFailure& failure) {
      log_error("'" + loaded->path + "': " + failure.what());
      code = ExitCode::numerical_failure;
    }
  }
  const auto is_any = [&proofs](Verdict verdict) {
    return std::any_of(proofs.begin(), proofs.end(), [verdict](const StaticProof& proof) { return proof.verdict == verdict; });
  };
  if (code == ExitCode::done && is_any(Verdict::reject)) code = ExitCode::criterion_failed;
  else if (code == ExitCode::done && is_any(Verdict::open)) code = ExitCode::numerical_failure;
  const std::string json = static_json(proofs, digests);
  if (arguments.output && !proofs.empty()) {
    std::filesystem::create_directories(*arguments.output);
    write_file(file, json, arguments.is_overwriting ? IfExists::replace : IfExists::refuse);
  }
  if (arguments.is_json) console.out << json;
  if (arguments.is_json || console.verbosity == Verbosity::quiet) return code;
  for (const StaticProof& proof : proofs) {
    if (&proof != &proofs.front()) console.out << "\n";
    print_proof(console.out, proof);
  }
  if (arguments.output && !proofs.empty()) console.out << "\nWritten to " << file << "\n";
  return code;
}

} // namespace steplap
