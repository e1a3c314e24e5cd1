// Voyages whose truth is known, from a whole record with the model run from its first sample to its last, and the same records damaged:
// no decision is more favourable than the truth unless it is open.
#include "driven_scene.h"

#include "tools/assess/vibration.h"
#include "tools/study/counter_random.h"
#include "transformer/recorder/fields.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

using namespace steplap;
using namespace steplap::assess;
using namespace assess_test;

namespace {

constexpr double k_limit = 2e-3; // m, that the block may slide

/// Draws of one voyage, always the same for its number.
class Draw {
public:
  explicit Draw(std::uint64_t voyage) : voyage_(voyage) {}
  double uniform(double low, double high) { return low + (high - low) * random_.uniform(voyage_, next_++); }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_.uniform(voyage_, next_++) * static_cast<double>(count)); }
  bool happens(double probability) { return random_.uniform(voyage_, next_++) < probability; }

private:
  study::CounterRandom random_{11, 3};
  std::uint64_t voyage_;
  std::uint32_t next_ = 0;
};

struct Row {
  double t = 0.0;
  std::array<double, 3> a{}; ///< g
};
struct Part { ///< a shock along x, or vibration
  double from = 0.0, length = 0.0, peak = 0.0, frequency = 0.0;
};
struct SampledRecord {
  double rate = 0.0; ///< Hz
  std::vector<Row> rows;
  std::vector<Part> parts;
};

double value_of(const Part& p, double t) {
  if (t < p.from || t > p.from + p.length) return 0.0;
  const double s = (t - p.from) / p.length;
  if (p.frequency == 0.0) return p.peak * std::sin(std::numbers::pi * s);
  const double envelope = std::min({1.0, 8.0 * s, 8.0 * (1.0 - s)});
  return p.peak * envelope * std::sin(2.0 * std::numbers::pi * p.frequency * (t - p.from));
}

// Some seconds at 250 or 500 Hz: shocks of 10 samples to 120 ms, of 0.3 to 2.5 g, or some seconds of vibration, and noise of 5 mg.
SampledRecord make_voyage(Draw& draw) {
  SampledRecord made;
  made.rate = draw.happens(0.2) ? 500.0 : 250.0;
  const double duration = draw.uniform(3.5, 5.5);
  double t = 1.2;
  while (t < duration - 1.5) {
    if (draw.happens(0.3)) made.parts.push_back({t, draw.uniform(0.8, 1.4), draw.uniform(0.15, 0.5), draw.uniform(6.0, 20.0)});
    else made.parts.push_back({t, draw.uniform(10.0 / made.rate, 0.12), draw.uniform(0.3, 2.5) * (draw.happens(0.5) ? 1.0 : -1.0), 0.0});
    t = made.parts.back().from + made.parts.back().length + draw.uniform(0.7, 1.8);
  }
  for (long i = 0; i < std::lround(duration * made.rate); ++i) {
    Row row{static_cast<double>(i) / made.rate, {}};
    double x = 0.0;
    for (const Part& part : made.parts) x += value_of(part, row.t);
    for (std::size_t k = 0; k < 3; ++k) row.a[k] = draw.uniform(-0.008, 0.008);
    row.a[0] += x, row.a[1] += 0.15 * x, row.a[2] += 1.0 + 0.05 * x;
    made.rows.push_back(row);
  }
  return made;
}

std::string csv_of(const std::vector<Row>& rows) {
  std::string text = "time [s],x [g],y [g],z [g]\n";
  for (const Row& row : rows) {
    char line[96];
    std::snprintf(line, sizeof line, "%.3f,%.5f,%.5f,%.5f\n", row.t, row.a[0], row.a[1], row.a[2]);
    text += line;
  }
  return text;
}

/// A block on a tank, and how it is asked.
struct Bench {
  explicit Bench(double mu) {
    std::string text = block_text(mu, "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"2 mm\"\n");
    const auto set = [&](const std::string& from, const std::string& to) { text.replace(text.find(from), from.size(), to); };
    set("tolerance = 1e-10", "tolerance = 1e-6"); // of slides of millimetres
    assess_test::write(model, text);
    options.reading.gravity = "z";
    options.sampling.samples = 0;
    options.estimating = Estimating::never;
    options.criteria = folder.file("criteria.toml");
    assess_test::write(options.criteria,
                       "name = \"models\"\n[[criterion]]\nname = \"models\"\nquantity = \"acceptance\"\noutcome = \"inspect\"\n");
  }
  void say_voyage(const SampledRecord& made) {
    options.voyage = parse_voyage(std::to_string(made.rows.front().t) + "," + std::to_string(made.rows.back().t));
  }
  // How far the block slides at most when all of the record drives it.
  [[nodiscard]] double whole_slide() const {
    EventRules all;
    all.each = std::array{0.0, 0.0, 0.0};
    RecordEvents events = read_without_events(record, options.reading);
    REQUIRE(find_events(options.reading, all, 1e9, events));
    REQUIRE(events.events.size() == 1);
    const DrivenModel driven = read_driven_model(model);
    VoyageModel traveller(driven);
    const Passage passage =
        traveller.pass(drive_history(events, events.events.front(), driven.recorder, driven.marker_angle), Estimating::never);
    for (const LimitPassage& limit : passage.clearances)
      if (limit.name == "slide") return std::abs(limit.value);
    return std::nan("");
  }
  [[nodiscard]] Assessment made() const { return assess::assess({record}, {model}, options); }

  Folder folder;
  std::string record = folder.file("voyage.csv"), model = folder.file("block.toml");
  AssessmentOptions options;
};

/// Ways in which a record is less than the voyage.
const char* const k_damages[] = {"its end is missing",
                                 "its begin is missing",
                                 "turned by 90 degrees",
                                 "an axis stops",
                                 "one bit",
                                 "rounded tops",
                                 "rows are missing",
                                 "a comment",
                                 "an odd last line",
                                 "a wrong unit",
                                 "a low filter",
                                 "low rate",
                                 "cut within a shock",
                                 "an axis is not read",
                                 "an axis toggles",
                                 "all stand still"};
constexpr std::size_t k_ways = std::size(k_damages);

const Part& strongest(const SampledRecord& made) {
  return *std::max_element(made.parts.begin(), made.parts.end(),
                           [](const Part& a, const Part& b) { return std::abs(a.peak) < std::abs(b.peak); });
}

std::string damaged(std::size_t way, SampledRecord made, Draw& draw, AssessmentOptions& options) {
  std::vector<Row>& rows = made.rows;
  const Part part = strongest(made);
  const auto at = [&](double t) {
    return rows.begin() + std::min<std::ptrdiff_t>(std::lround(t * made.rate), static_cast<std::ptrdiff_t>(rows.size()));
  };
  switch (way) {
  case 0: rows.erase(at(draw.uniform(1.0, rows.back().t)), rows.end()); break;
  case 1: rows.erase(rows.begin(), at(draw.uniform(0.1, rows.back().t - 1.0))); break;
  case 2:
    for (Row& row : rows) row.a = {-row.a[1], row.a[0], row.a[2]};
    break;
  case 3: {
    const auto from = at(draw.uniform(0.5, part.from));
    for (auto row = from; row != rows.end(); ++row) row->a[0] = 0.0;
    break;
  }
  case 4:
    for (Row& row : rows) row.a[0] = 0.004 * std::clamp(std::round(row.a[0] / 0.02), -1.0, 1.0);
    break;
  case 5: {
    const double ceiling = std::abs(part.peak) * draw.uniform(0.3, 0.5);
    for (Row& row : rows) row.a[0] = ceiling * std::tanh(row.a[0] / ceiling) + draw.uniform(-0.002, 0.002);
    break;
  }
  case 6: rows.erase(at(part.from - 0.004), at(part.from + std::min(part.length, 0.2) + 0.004)); break;
  case 7: {
    std::string text = csv_of(rows);
    for (const char* line : {"# restarted\n"}) text.insert(text.find('\n', text.size() / 2) + 1, line);
    // The strongest shock is not in it.
    return text;
  }
  case 8: return csv_of(rows) + "; U=2.1 V\n";
  case 9:
    options.reading.gravity.reset();
    options.reading.rest = std::array{0.0, 1.0};
    options.reading.read.unit = "m/s^2";
    break;
  case 10: options.reading.frequency_class = 5.0; break;
  case 11:
    for (std::size_t i = 0; i * 12 < rows.size(); ++i) rows[i] = rows[i * 12];
    rows.resize(rows.size() / 12);
    break;
  case 12: rows.erase(at(part.from + 0.3 * part.length), rows.end()); break;
  case 13: options.reading.read.x = "2", options.reading.read.z = "4"; break;
  case 14:
    for (auto row = at(part.from - 0.1); row != rows.end(); ++row) row->a[0] = draw.happens(0.5) ? 0.004 : 0.0;
    break;
  default: {
    const std::array<double, 3> last = at(part.from - 0.05)->a;
    for (auto row = at(part.from - 0.05); row != at(part.from + part.length + 0.05); ++row) row->a = last;
  }
  }
  return csv_of(rows);
}

long wanted() {
  const char* const given = std::getenv("STEPLAP_VOYAGES"); // more of them, by hand
  return given ? std::atol(given) : 100;
}

} // namespace

TEST_CASE("no decision on a damaged record is more favourable than the truth, and whole records are decided") {
  const long damages = wanted(), whole = damages / 4;
  long open = 0, kept = 0, harmful = 0, energised = 0;
  for (std::uint64_t number = 1; kept < damages; ++number) {
    Draw draw(number);
    const SampledRecord made = make_voyage(draw);
    Bench bench(draw.uniform(0.3, 0.7));
    bench.say_voyage(made);
    assess_test::write(bench.record, csv_of(made.rows));
    const double slide = bench.whole_slide();
    constexpr double k_near = 0.05; // of the limit: two ways of cutting the record may differ in it, as two percent of a margin may
    if (std::abs(slide / k_limit - 1.0) < k_near) continue;
    const Decision truth = slide > k_limit ? Decision::inspect : Decision::energise;
    CAPTURE(number);
    CAPTURE(slide);
    if (kept < whole) {
      const Assessment a = bench.made();
      CAPTURE(a.reason);
      open += a.decision == Decision::open;
      CHECK((a.decision == Decision::open || a.decision == truth));
      energised += a.decision == Decision::energise;
    }
    ++kept;
    harmful += truth == Decision::inspect;
    const std::size_t way = draw.below(k_ways);
    CAPTURE(std::string(k_damages[way]));
    assess_test::write(bench.record, damaged(way, made, draw, bench.options));
    try {
      const Assessment a = bench.made();
      CAPTURE(a.reason);
      CHECK((a.decision == Decision::open || a.decision >= truth));
    } catch (const FileError&) { // refused
    }
  }
  CHECK(open <= whole / 20); // 95 % of the whole records are decided
  MESSAGE("of " << whole << " whole records " << open << " are open, " << energised << " energised; of " << damages << " voyages "
                << harmful << " did harm");
  CHECK(harmful > damages / 5); // both truths are common
  CHECK(energised > whole / 5);
}
