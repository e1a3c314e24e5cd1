// Stores that were damaged or edited, and studies whose files have changed: each is noticed, none is read as if it were
// what was written.
#include "tests/tools/study/block_scene.h"
#include "tests/tools/study/study_bench.h"

#include <sqlite3.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

const std::string k_small = "kind = \"reliability\"\n[reliability]\nmethods = [\"form\", \"monte_carlo\"]\nsamples = 300\ncov = 0.5\n"
                            "[[variable]]\nname = \"x\"\ndistribution = \"normal\"\nmean = 0\nstandard_deviation = 1\n"
                            "[[response]]\nname = \"y\"\nexpression = \"2*x\"\n"
                            "[[limit_state]]\nname = \"g\"\nexpression = \"sqrt(2 - y) - 1\"\n";

// SQL of another program's on a store.
void edit(const std::string& store, const std::string& sql) {
  sqlite3* database = nullptr;
  REQUIRE(sqlite3_open(store.c_str(), &database) == SQLITE_OK);
  char* problem = nullptr;
  sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &problem);
  const std::string said = problem ? problem : "";
  sqlite3_free(problem);
  sqlite3_close(database);
  CAPTURE(sql);
  REQUIRE(said.empty());
}

// All that can be read of a store; nothing if it is refused.
std::optional<std::string> all_of(const std::string& path) {
  try {
    study::Store store(path);
    std::ostringstream text;
    text.precision(17);
    const study::StoreIdentity& id = store.identity();
    text << id.version << id.study << id.kind << id.scene << store.setting("standing") << store.setting("about") << store.setting("files")
         << store.size();
    std::vector<study::StoredSample> rows;
    store.read(1, store.size(), rows);
    for (const study::StoredSample& row : rows) {
      text << "\n"
           << row.number << study::name_of(row.outcome.status) << row.outcome.reason << row.outcome.error << "," << row.outcome.evaluations
           << "," << row.outcome.cpu_seconds;
      for (const double x : row.values) text << "," << x;
      for (const double x : row.outcome.numbers) text << "," << x;
    }
    for (const auto& findings : {store.findings(), store.growth()})
      for (const study::Finding& f : findings)
        text << "\n" << f.method << f.subject << f.quantity << f.value << "," << f.low << "," << f.high << "," << f.samples << f.status;
    for (const std::string& note : store.notes()) text << "\n" << note;
    for (const study::Store::Reason& r : store.reasons()) text << "\n" << r.status << r.reason << r.count << "," << r.first;
    for (std::size_t i = 0; i < id.numbers.size(); ++i) text << "\n" << store.count_of(i) << "," << store.order_statistic(i, 3);
    return text.str();
  } catch (const study::StoreError&) {
    return {};
  }
}

// Some samples of each kind, batches, findings, notes: the study's own text, as it has no page.
std::string small_store(const StudyBench& bench) {
  const std::string path = bench.at("small.sqlite");
  study::StoreIdentity identity = study::identity_of(study::parse_study(k_small, "study.toml"));
  identity.study = "kind = \"reliability\"";
  identity.scene = "# limit state g | 1 - x";
  study::Store store(path, identity, study::StoreMode::run);
  for (long number = 1; number <= 12; ++number) {
    const double x = 0.1 * static_cast<double>(number * number), nan = std::nan("");
    study::StoredSample row{number, {x}, {}};
    row.outcome.numbers = {2.0 * x, number % 5 ? 1.0 - x : nan};
    row.outcome.evaluations = static_cast<double>(100 * number);
    row.outcome.cpu_seconds = 0.001 * x;
    row.outcome.error = x * 1e-9;
    if (number % 5 == 0) row.outcome.status = study::SampleStatus::not_a_number, row.outcome.reason = "limit state 'g' has no value";
    store.append(&row, 1);
  }
  for (long k = 1; k <= 3; ++k) store.note(k, {"monte_carlo", "g", "probability", 0.1 / static_cast<double>(k), 0.01, 0.3, 4 * k});
  store.set_findings({{"monte_carlo", "g", "probability", 0.031, 0.02, 0.04, 12, "all samples used"}}, {"2 runs have no value"}, "not met");
  return path;
}

} // namespace

// Of each byte of the file one bit, another at each place, and all of its bits. Bytes that nobody reads may change: then
// what is read is what it was.
TEST_CASE("a store with any one of its bytes changed is refused, or reads as it did") {
  StudyBench bench;
  const std::string path = small_store(bench), damaged = bench.at("damaged.sqlite");
  edit(path, "PRAGMA page_size = 512; VACUUM"); // a small file, with more inner pages
  const std::optional<std::string> whole = all_of(path);
  REQUIRE(whole);
  const std::string bytes = text_of(path);
  long refused = 0, alike = 0, unnoticed = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const int mask = i % 2 ? 1 << (i / 2 % 8) : 0xff;
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ mask);
    bench.write("damaged.sqlite", changed);
    const std::optional<std::string> read = all_of(damaged);
    refused += !read;
    alike += read && *read == *whole;
    if (!read || *read == *whole) continue;
    ++unnoticed;
    MESSAGE("byte " << i << " of " << bytes.size() << ", mask " << mask);
  }
  CHECK(unnoticed == 0);
  CHECK(refused > static_cast<long>(bytes.size()) / 4); // pages are half empty
  CHECK(refused + alike == static_cast<long>(bytes.size()));
}

TEST_CASE("a store that was cut off, or of which pieces are gone, is refused, or reads as it did") {
  StudyBench bench;
  (void)bench.run(k_small);
  const std::string bytes = text_of(bench.at("study.sqlite"));
  const std::optional<std::string> whole = all_of(bench.at("study.sqlite"));
  int refused = 0;
  for (std::size_t k = 1; k < 20; ++k) {
    const std::size_t length = bytes.size() * k / 20;
    bench.write("damaged.sqlite", bytes.substr(0, length));
    CAPTURE(k);
    const std::optional<std::string> rest = all_of(bench.at("damaged.sqlite"));
    CHECK((!rest || *rest == *whole)); // the last page may end with nothing
    std::string zeros = bytes;
    std::fill(zeros.begin() + static_cast<long>(bytes.size() * (k - 1) / 20), zeros.begin() + static_cast<long>(length), '\0');
    bench.write("damaged.sqlite", zeros);
    const std::optional<std::string> read = all_of(bench.at("damaged.sqlite"));
    CHECK((!read || *read == *whole)); // there may have been nothing but zeros
    refused += !rest + !read;
  }
  CHECK(refused > 25); // of 38
}

TEST_CASE("what was edited is refused by whatever reads the store") {
  for (const char* sql : {"UPDATE sample SET status = 77 WHERE number = 5",
                          "UPDATE sample SET status = 1000000",
                          "UPDATE sample SET status = -1",
                          "UPDATE sample SET r_g = 1 WHERE number = 17",
                          "UPDATE sample SET r_y = NULL WHERE number = 17",
                          "UPDATE sample SET v_x = v_x + 1e-9 WHERE number = 200",
                          "UPDATE sample SET reason = 'none' WHERE number = 3",
                          "DELETE FROM sample WHERE number > 250",
                          "DELETE FROM sample WHERE number = 20",
                          "DELETE FROM batch",
                          "UPDATE finding SET value = value/2",
                          "DELETE FROM finding WHERE place = (SELECT max(place) FROM finding)",
                          "UPDATE growth SET samples = 3",
                          "UPDATE setting SET value = 'done' WHERE key = 'kind'",
                          "DELETE FROM setting WHERE key = 'scene'",
                          "UPDATE setting SET value = 'not met' WHERE key = 'standing'",
                          "UPDATE note SET text = 'all is well'",
                          "INSERT INTO note VALUES (99, 'all is well', 0)",
                          "ALTER TABLE sample RENAME COLUMN r_g TO r_h",
                          "UPDATE sample SET number = number + 1000",
                          "INSERT INTO sample (number, status) VALUES (301, 0)"}) {
    CAPTURE(std::string(sql));
    StudyBench bench;
    (void)bench.run(k_small);
    const std::string store = bench.at("study.sqlite"), file = bench.at("study.toml"), before = text_of(store);
    edit(store, sql);
    if (text_of(store) == before) continue; // there was nothing of that kind
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"show", store},
                                                      {"export", store},
                                                      {"export", store, "--findings"},
                                                      {"report", store, "-o", bench.at("page.html"), "--force"},
                                                      {"run", file, "-o", store},
                                                      {"run", file, "-o", store, "--changed"}}) {
      const Outcome outcome = study_does(arguments);
      CAPTURE(arguments.front());
      CHECK(outcome.code == 2);
      CHECK(outcome.out.empty());
    }
    CHECK(bench.run(k_small, {"--restart"}).code != 2);
    CHECK(all_of(store));
  }
}

// The edit of one who knows about fingerprints: values that follow from others are held against these when a study goes on.
TEST_CASE("an edited value that follows from others is found, whatever the fingerprints say") {
  StudyBench bench;
  const std::string file = bench.write("study.toml", k_small), store = bench.at("study.sqlite");
  const study::LoadedStudy loaded = study::read_study(file);
  for (const int what : {0, 1, 2, 3}) {
    CAPTURE(what);
    (void)bench.run(k_small, {"--restart"});
    std::vector<study::StoredSample> rows;
    {
      study::Store whole(store);
      whole.read(1, whole.size(), rows);
    }
    if (what == 0) rows[30].values[0] += 0.25;
    if (what == 1) rows[30].outcome.numbers[0] += 0.25;
    if (what == 2) rows[30].outcome.numbers[1] = -1.0;
    {
      study::Store other(store, study::identity_of(loaded), study::StoreMode::restart);
      other.append(rows.data(), rows.size());
      other.flush();
    }
    const Outcome outcome = study_does({"run", file, "-o", store});
    CHECK((outcome.code == 2) == (what != 3)); // untouched it goes on
    if (what != 3) CHECK(has(outcome.err, "sample 31 has"));
  }
}

namespace {

// A study whose model extends another and takes its load from a record; a distribution that is measured.
struct Files {
  explicit Files(const StudyBench& bench) {
    bench.write("base.toml", k_block);
    bench.write("block.toml", "extends = \"base.toml\"\n[[signal]]\nname = \"shock record\"\nkind = \"record\"\nfile = \"shock.csv\"\n"
                              "[[element]]\nname = \"drive\"\nsignal = \"shock record\"\n");
    bench.write("shock.csv", "t,a\n0,5.886\n0.1,5.886\n");
    bench.write("mu.csv", "mu\n0.2\n0.25\n0.28\n0.3\n0.33\n0.35\n0.4\n0.31\n0.29\n0.27\n");
    bench.write("parent.toml", "kind = \"sample\"\nmodel = \"block.toml\"\n[sample]\nsamples = 12\n");
  }
  const std::string study = "extends = \"parent.toml\"\n[[variable]]\nname = \"mu\"\npath = \"element.deck friction.static_friction\"\n"
                            "distribution = \"lognormal\"\nmeasured = \"mu.csv\"\ncolumn = \"mu\"\n" +
                            k_slid;
};

void replace(const StudyBench& bench, const std::string& name, const std::string& from, const std::string& to) {
  std::string text = text_of(bench.at(name));
  REQUIRE(has(text, from));
  bench.write(name, text.replace(text.find(from), from.size(), to));
}

} // namespace

TEST_CASE("every file that a study or its models read belongs to what a store is of") {
  struct Change {
    const char *file, *from, *to;
    bool is_of_scene; ///< samples are other ones then; else the study asks for others, which --changed allows
  };
  const Change changes[] = {{"shock.csv", "0.1,5.886", "0.1,1.5", true},
                            {"base.toml", "5.886", "3.5", true},
                            {"block.toml", "\"shock record\"\nkind", "\"shock record\"\nscale = 0.5\nkind", true},
                            {"mu.csv", "0.4\n", "0.42\n", false},
                            {"parent.toml", "samples = 12", "samples = 14", false}};
  for (const Change& change : changes) {
    CAPTURE(std::string(change.file));
    StudyBench bench;
    const Files files(bench);
    const Outcome first = bench.run(files.study);
    CAPTURE(first.err);
    REQUIRE(first.code != 3);
    REQUIRE(first.code != 2);
    const std::string before = bench.samples();
    CHECK(has(study_does({"show", bench.at("study.sqlite")}).out, std::string("Read from ") + bench.at(change.file)));
    CHECK(bench.run(files.study).code == first.code); // unchanged: goes on
    CHECK(bench.samples() == before);
    replace(bench, change.file, change.from, change.to);
    Outcome outcome = bench.run(files.study);
    CHECK(outcome.code == 2);
    CHECK(has(outcome.err, std::string("'") + bench.at(change.file) + "'"));
    CHECK(bench.samples() == before);
    outcome = bench.run(files.study, {"--changed"});
    CHECK((outcome.code == 2) == change.is_of_scene);
    if (change.is_of_scene) CHECK(bench.samples() == before);
    CHECK(bench.run(files.study, {"--restart"}).code != 2);
    StudyBench anew;
    const Files others(anew);
    for (const char* name : {"shock.csv", "base.toml", "block.toml", "mu.csv", "parent.toml"}) anew.write(name, text_of(bench.at(name)));
    (void)anew.run(files.study);
    CHECK(bench.samples() == anew.samples());
  }
}

// The same of the study's own file; of a record that a fit compares a channel with: fit_test.cpp.
TEST_CASE("a store does not go on after its study's own file has changed") {
  StudyBench bench;
  const std::string file = bench.write("study.toml", k_small), store = bench.at("study.sqlite");
  const int first = study_does({"run", file, "-o", store}).code;
  REQUIRE(first != 2);
  REQUIRE(first != 3);
  CHECK(study_does({"run", file, "-o", store}).code == first);
  replace(bench, "study.toml", "2*x", "2.5*x");
  CHECK(study_does({"run", file, "-o", store}).code == 2);
  CHECK(study_does({"run", file, "-o", store, "--restart"}).code != 2);
}
