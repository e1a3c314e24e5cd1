// Study kind "sweep": evaluates given values one after the other.
#include "tools/study/kinds.h"

#include "mbd/base/number_text.h"
#include "tools/study/grid.h"

#include <cmath>

namespace steplap::study {

namespace {

/// Settings of a "sweep" study.
struct SweepSettings : KindSettings {
  std::string design = "grid"; ///< choice of points: grid, list, one_at_a_time
  long points = 11;            ///< number of points over a range, or over the 5 % to 95 % quantiles of a distribution
};

FieldTable sweep_fields() {
  FieldTable t;
  t.add("design", &SweepSettings::design)
      .one_of({"grid", "list", "one_at_a_time"})
      .doc("grid: all combinations; list: the first values of all, the second, ...; one at a time: the others stay at "
           "their value");
  t.add("points", &SweepSettings::points).at_least(2).at_most(1e6).doc("of a variable with a range, or a distribution (from 5 % to 95 %)");
  return t;
}

constexpr std::size_t k_block = 10000; // largest number of samples per request, which limits the memory

// Returns the values of a variable in the sweep.
std::vector<double> levels_of(const StudyRun& run, std::size_t i) {
  const Variable& v = run.study().variables[i];
  if (!v.values.empty()) return v.values;
  const auto& random = run.law.random();
  const auto found = std::find(random.begin(), random.end(), i);
  if (found == random.end()) return {run.law.nominal()[i]};
  const auto n = static_cast<std::size_t>(settings_of<SweepSettings>(run.study()).points);
  std::vector<double> levels;
  for (std::size_t k = 0; k < n; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(n - 1);
    if (v.has_distribution()) levels.push_back(run.law.quantile(static_cast<std::size_t>(found - random.begin()), 0.05 + 0.9 * share));
    else levels.push_back(k + 1 == n ? v.range[1] : v.range[0] + share * (v.range[1] - v.range[0]));
  }
  return levels;
}

// Minimum and maximum of every number, with their locations.
class Extent {
public:
  explicit Extent(std::size_t count) : low_(count), high_(count) {}

  void add(const StoredSample& sample) {
    ++total_;
    bad_ += sample.outcome.status != SampleStatus::ok;
    for (std::size_t i = 0; i < low_.size(); ++i) {
      const double x = sample.outcome.numbers[i];
      if (std::isnan(x)) continue;
      if (low_[i].number == 0 || x < low_[i].value) low_[i] = {x, sample.number};
      if (high_[i].number == 0 || x > high_[i].value) high_[i] = {x, sample.number};
    }
  }

  void report(const LoadedStudy& loaded, Answer& answer) const {
    const std::vector<std::string> names = loaded.number_names();
    for (std::size_t i = 0; i < low_.size(); ++i)
      for (const bool is_high : {false, true}) {
        const Place& place = is_high ? high_[i] : low_[i];
        Finding f{"sweep", names[i], is_high ? "highest" : "lowest"};
        f.samples = total_;
        if (place.number) f.value = place.value;
        f.status = place.number ? "at sample " + std::to_string(place.number) : "no run gave a value";
        answer.findings.push_back(f);
      }
    if (bad_) {
      answer.notes.push_back(std::to_string(bad_) + " of " + std::to_string(total_) +
                             " runs did not reach their end or are not to be trusted: see the reasons");
      answer.degrade(Standing::not_met);
    }
  }

private:
  struct Place {
    double value = 0.0;
    long number = 0;
  };
  std::vector<Place> low_, high_;
  long total_ = 0, bad_ = 0;
};

class Sweeper {
public:
  explicit Sweeper(StudyRun& run) : run_(run), extent_(run.loaded.number_count()) {}

  void add(const std::vector<double>& point) {
    points_.insert(points_.end(), point.begin(), point.end());
    if (points_.size() >= k_block * point.size()) flush();
  }
  void flush() {
    for (const StoredSample& sample : run_.evaluator.evaluate(points_)) extent_.add(sample);
    points_.clear();
  }
  [[nodiscard]] const Extent& extent() const { return extent_; }

private:
  StudyRun& run_;
  Extent extent_;
  std::vector<double> points_;
};

void sweep_list(const std::vector<std::vector<double>>& levels, Sweeper& sweeper) {
  std::size_t longest = 1;
  for (const auto& list : levels) longest = std::max(longest, list.size());
  for (std::size_t k = 0; k < longest; ++k) {
    std::vector<double> point;
    for (const auto& list : levels) point.push_back(list.size() == 1 ? list[0] : list[k]);
    sweeper.add(point);
  }
}

void sweep_one_at_a_time(const std::vector<std::vector<double>>& levels, const std::vector<double>& nominal, Sweeper& sweeper) {
  sweeper.add(nominal);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    std::vector<double> point = nominal;
    if (levels[i].size() == 1) continue;
    for (const double x : levels[i]) {
      point[i] = x;
      sweeper.add(point);
    }
  }
}

void check_sweep(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const Study& study = loaded.study;
  const auto& s = settings_of<SweepSettings>(study);
  double count = 1.0;
  std::size_t longest = 0;
  for (const Variable& v : study.variables) {
    const double levels = !v.values.empty()                          ? static_cast<double>(v.values.size())
                          : v.range.empty() && !v.has_distribution() ? 1.0
                                                                     : static_cast<double>(s.points);
    count *= levels;
    if (s.design != "list" || levels == 1.0) continue;
    if (longest && static_cast<double>(longest) != levels)
      problems.push_back({v.where, "variable '" + v.name + "' has " + number_text(levels) + " values, those before it " +
                                       std::to_string(longest) +
                                       ": a sweep of the design \"list\" takes the first of all, then the second, and so on"});
    longest = static_cast<std::size_t>(levels);
  }
  if (study.variables.empty()) problems.push_back({study.where, "a sweep needs a [[variable]]"});
  if (s.design == "grid" && count > 1e9) problems.push_back({s.where, "the grid has " + number_text(count) + " points: too many"});
}

long points_of(const std::string& design, const std::vector<std::vector<double>>& levels) {
  std::size_t product = 1, sum = 1, longest = 1;
  for (const auto& list : levels) {
    product *= list.size();
    if (list.size() > 1) sum += list.size();
    longest = std::max(longest, list.size());
  }
  return static_cast<long>(design == "grid" ? product : design == "list" ? longest : sum);
}

Answer run_sweep(StudyRun& run) {
  std::vector<std::vector<double>> levels;
  for (std::size_t i = 0; i < run.study().variables.size(); ++i) levels.push_back(levels_of(run, i));
  Sweeper sweeper(run);
  const std::string& design = settings_of<SweepSettings>(run.study()).design;
  run.evaluator.expect(points_of(design, levels));
  if (design == "grid") visit_grid(levels, [&](const std::vector<double>& point) { sweeper.add(point); });
  else if (design == "list") sweep_list(levels, sweeper);
  else sweep_one_at_a_time(levels, run.law.nominal(), sweeper);
  sweeper.flush();
  Answer answer;
  sweeper.extent().report(run.loaded, answer);
  return answer;
}

} // namespace

StudyKind sweep_kind() {
  StudyKind kind;
  kind.name = "sweep";
  kind.doc = "values tried one after the other: a grid, a list, one variable at a time";
  kind.fields = sweep_fields();
  kind.holds<SweepSettings>();
  kind.shown = {"design"};
  kind.parts = {{"extreme", "lowest", UnitOf::subject}, {"extreme", "highest", UnitOf::subject}};
  kind.check = check_sweep;
  kind.run = run_sweep;
  return kind;
}

} // namespace steplap::study
