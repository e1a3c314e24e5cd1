#include "tools/assess/sample_store.h"

#include "mbd/base/number_text.h"
#include "mbd/io/digest.h"
#include "mbd/run/version.h"

#include <array>
#include <filesystem>

namespace steplap::assess {

namespace {

constexpr std::array<const char*, 10> k_numbers{"least_margin", "slid",       "overlap_left", "slips",  "lifts",
                                                "comes_apart",  "acceptance", "planes_use",   "planes", "known_acceptance"};

// Returns a text of everything that affects the outcome of a sample.
std::string scene_of(const SamplingOptions& options, const std::vector<DrivenModel>& models,
                     const std::vector<std::vector<DriveHistory>>& histories, const UncertainValues& uncertain) {
  std::string scene = "seed " + std::to_string(options.seed) + "\n";
  for (std::size_t m = 0; m < models.size(); ++m) {
    Sha256 sum;
    for (const DriveHistory& h : histories[m])
      for (const std::vector<double>* values : {&h.x, &h.y, &h.across})
        sum.add({reinterpret_cast<const char*>(values->data()), values->size() * sizeof(double)});
    scene += "model " + sha256(models[m].text) + " driven by " + sum.hex();
    for (const DriveHistory& h : histories[m]) scene += " " + number_text(h.step) + "*" + std::to_string(h.x.size());
    scene += "\n";
  }
  for (std::size_t i = 0; i < uncertain.values().size(); ++i) scene += uncertain.values()[i].name + ": " + uncertain.law_text(i) + "\n";
  return scene;
}

study::StoredSample stored(const VoyageSample& sample, long number) {
  study::StoredSample row;
  row.number = number;
  row.values = sample.values;
  const VoyageSummary& s = sample.summary;
  row.outcome.status = s.unknown.empty() ? study::SampleStatus::ok : study::SampleStatus::gave_up;
  row.outcome.reason = s.unknown;
  row.outcome.numbers = {s.least_margin,
                         s.slid,
                         s.overlap_left,
                         s.slips ? 1.0 : 0.0,
                         s.lifts ? 1.0 : 0.0,
                         s.comes_apart ? 1.0 : 0.0,
                         static_cast<double>(s.limits.outcome),
                         s.planes_use,
                         static_cast<double>(s.planes),
                         static_cast<double>(s.known_limits.outcome)};
  row.outcome.curve.assign(sample.slips.begin(), sample.slips.end());
  return row;
}

void restore(const study::StoredSample& row, VoyageSample& sample) {
  VoyageSummary& s = sample.summary;
  const std::vector<double>& n = row.outcome.numbers;
  s.unknown = row.outcome.reason;
  s.least_margin = n[0], s.slid = n[1], s.overlap_left = n[2];
  s.slips = n[3] != 0.0, s.lifts = n[4] != 0.0, s.comes_apart = n[5] != 0.0;
  s.limits.outcome = static_cast<Verdict>(static_cast<int>(n[6]));
  s.planes_use = n[7];
  s.planes = static_cast<Verdict>(static_cast<int>(n[8]));
  s.known_limits.outcome = static_cast<Verdict>(static_cast<int>(n[9]));
  sample.slips.clear();
  for (const double slip : row.outcome.curve) sample.slips.push_back(slip != 0.0 ? 1 : 0);
}

} // namespace

SampleStore::SampleStore(const SamplingOptions& options, const std::vector<DrivenModel>& models,
                         const std::vector<std::vector<DriveHistory>>& histories, const UncertainValues& uncertain) {
  if (options.store.empty()) return;
  study::StoreIdentity identity;
  identity.version = k_version;
  identity.kind = "assessment";
  identity.scene = identity.study = scene_of(options, models, histories, uncertain);
  for (std::size_t i = 0; i < uncertain.values().size(); ++i) identity.variables.push_back("u" + std::to_string(i + 1));
  identity.numbers.assign(k_numbers.begin(), k_numbers.end());
  identity.has_curves = true;
  const std::filesystem::path folder = std::filesystem::path(options.store).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  try {
    store_ = std::make_unique<study::Store>(options.store, identity, study::StoreMode::run);
  } catch (const study::StoreError& error) {
    if (error.usable_modes().empty()) throw; // restarting does not help if another process uses the file, or if it is not writable
    store_ = std::make_unique<study::Store>(options.store, identity, study::StoreMode::restart);
  }
}

long SampleStore::load(std::vector<VoyageSample>& samples) {
  if (!store_) return 0;
  std::vector<study::StoredSample> rows;
  const long count = std::min(store_->size(), static_cast<long>(samples.size()));
  if (count > 0) store_->read(1, count, rows);
  long known = 0;
  for (const study::StoredSample& row : rows) {
    VoyageSample& sample = samples[static_cast<std::size_t>(known)];
    if (row.values != sample.values || row.outcome.numbers.size() != k_numbers.size()) break; // changed store: recompute from here
    restore(row, sample);
    ++known;
  }
  if (known < count) store_->forget_from(known + 1);
  return known;
}

void SampleStore::append(const std::vector<VoyageSample>& samples, long begin, long end) {
  if (!store_) return;
  std::vector<study::StoredSample> rows;
  for (long n = begin; n < end; ++n) rows.push_back(stored(samples[static_cast<std::size_t>(n)], n + 1));
  store_->append(rows.data(), rows.size());
  store_->flush();
}

} // namespace steplap::assess
