// What happens to a store: threads, ranks, interruptions, changed studies, disks that cannot be written.
#include "tests/tools/study/study_bench.h"
#include "tools/study/store_writer.h"
#include "tools/study/study_reader.h"

#include <fcntl.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <thread>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string reliability_text(const std::string& settings = "samples = 20000") {
  return "kind = \"reliability\"\n[reliability]\nmethods = [\"form\", \"importance_sampling\", \"subset\", "
         "\"monte_carlo\"]\ncov = 0.02\n" +
         settings +
         "\n[[variable]]\nname = \"x1\"\ndistribution = \"normal\"\nmean = 0\nstandard_deviation = 1\n"
         "[[variable]]\nname = \"x2\"\ndistribution = \"lognormal\"\nmean = 1\ncov = 0.3\n"
         "[[limit_state]]\nname = \"g\"\nexpression = \"2.5 - x1 - x2^2/3\"\n";
}

pid_t start(const std::vector<std::string>& arguments) {
  const pid_t child = fork();
  if (child != 0) return child;
  std::vector<char*> words;
  for (const std::string& a : arguments) words.push_back(const_cast<char*>(a.c_str()));
  words.push_back(nullptr);
  const int null = open("/dev/null", O_WRONLY);
  dup2(null, 1);
  dup2(null, 2);
  execvp(words[0], words.data());
  _exit(127);
}

int wait_for(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace

TEST_CASE("the export is the same bytes for every number of threads") {
  std::string first;
  for (const char* threads : {"1", "2", "5"}) {
    StudyBench bench;
    (void)bench.run(reliability_text(), {"--threads", threads});
    if (first.empty()) first = bench.samples();
    CHECK(bench.samples() == first);
  }
  CHECK(std::count(first.begin(), first.end(), '\n') > 20000);
}

// What a process leaves behind that is killed while its batch is half in the file: the file and the journal of a
// transaction that is open, copied.
TEST_CASE("a store whose last batch was cut off is shown and exported without it") {
  StudyBench bench;
  (void)bench.run(reliability_text("samples = 3000"));
  const std::string whole = bench.samples(), cut = bench.at("cut.sqlite");
  sqlite3* database = nullptr;
  REQUIRE(sqlite3_open(bench.at("study.sqlite").c_str(), &database) == SQLITE_OK);
  // A cache of a few pages, so that changed ones go into the file before the end.
  const char* change = "PRAGMA cache_size = 4; BEGIN; UPDATE sample SET r_g = 17;";
  REQUIRE(sqlite3_exec(database, change, nullptr, nullptr, nullptr) == SQLITE_OK);
  fs::copy_file(bench.at("study.sqlite"), cut);
  fs::copy_file(bench.at("study.sqlite-journal"), cut + "-journal");
  sqlite3_close(database);
  CHECK(text_of(cut) != text_of(bench.at("study.sqlite")));
  const Outcome shown = study_does({"show", cut});
  CAPTURE(shown.err);
  CHECK(shown.code == 0);
  CHECK(study_does({"export", cut}).out == whole);
  CHECK_FALSE(fs::exists(cut + "-journal"));
}

TEST_CASE("a study that is killed at any instant goes on, and comes to the same bytes") {
  const std::string text = reliability_text("samples = 100000");
  StudyBench whole;
  (void)whole.run(text);
  const std::string wanted = whole.samples(), findings = study_does({"export", whole.at("study.sqlite"), "--findings"}).out;
  StudyBench bench;
  const std::string file = bench.write("study.toml", text), store = bench.at("study.sqlite");
  int killed = 0;
  for (int k = 0; k < 5; ++k) {
    const pid_t child = start({STEPLAP_PROGRAM, "study", file, "-o", store, "--threads", "2"});
    std::this_thread::sleep_for(std::chrono::milliseconds(60 + 70 * k));
    kill(child, SIGKILL);
    killed += wait_for(child) == -1;
  }
  CHECK(killed > 0);
  const Outcome outcome = bench.run(text);
  CAPTURE(outcome.err);
  CHECK(bench.samples() == wanted);
  CHECK(study_does({"export", store, "--findings"}).out == findings);
}

TEST_CASE("a study over MPI's ranks comes to the same bytes" * doctest::skip(std::string(STEPLAP_MPIRUN).empty())) {
  const std::string text = reliability_text();
  StudyBench alone, together;
  (void)alone.run(text);
  const std::string file = together.write("study.toml", text);
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1); // containers
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  const int code =
      wait_for(start({STEPLAP_MPIRUN, "--oversubscribe", "-n", "3", STEPLAP_PROGRAM, "study", file, "-o", together.at("study.sqlite")}));
  CHECK((code == 0 || code == 5));
  CHECK(together.samples() == alone.samples());
}

TEST_CASE("what cannot be written is told with the next request, and nothing is written after it") {
  StudyBench bench;
  (void)bench.run(reliability_text("samples = 400"));
  const study::LoadedStudy loaded = study::read_study(bench.at("study.toml"));
  const std::string path = bench.at("written.sqlite");
  {
    study::Store store(path, study::identity_of(loaded), study::StoreMode::run);
    study::StoreWriter writer(store);
    const auto rows = [&](long first, long count) {
      std::vector<study::StoredSample> made(static_cast<std::size_t>(count));
      for (study::StoredSample& row : made) {
        row.number = first++;
        row.values.assign(loaded.study.variables.size(), static_cast<double>(row.number));
        row.outcome.numbers.assign(loaded.number_names().size(), 0.5);
      }
      return made;
    };
    // More at once than are left to wait, in many parts: all of them, in their order.
    for (long first = 1; first < 60000; first += 500) writer.append(rows(first, 500));
    CHECK(writer.store().size() == 60000);
    writer.append(rows(1, 3)); // numbers that are there
    CHECK_THROWS_AS((void)writer.store(), study::StoreError);
    CHECK_THROWS_AS(writer.append(rows(60001, 3)), study::StoreError);
    CHECK_THROWS_AS(writer.note(1, {}), study::StoreError);
  }
  study::Store kept(path);
  REQUIRE(kept.size() == 60000);
  std::vector<study::StoredSample> read;
  kept.read(1, 60000, read);
  long wrong = 0;
  for (long i = 0; i < 60000; ++i) wrong += read[static_cast<std::size_t>(i)].values[0] != static_cast<double>(i + 1);
  CHECK(wrong == 0);
}

TEST_CASE("a store goes on with its own study only") {
  StudyBench bench;
  (void)bench.run(reliability_text());
  const std::string before = bench.samples();
  SUBCASE("unchanged: nothing is run again") {
    const Outcome outcome = bench.run(reliability_text());
    CHECK(has(outcome.err + outcome.out, "going on with"));
    CHECK(bench.samples() == before);
  }
  SUBCASE("other settings are refused unless told; what is the same is kept") {
    const std::string longer = reliability_text("samples = 30000\nseed = 1");
    Outcome outcome = bench.run(reliability_text("samples = 20000\nstarts = 9"));
    CHECK(outcome.code == 2);
    CHECK(has(outcome.err, "(steplap study run: --changed, --restart, -o)"));
    CHECK(bench.samples() == before);
    CHECK(bench.run(reliability_text("samples = 20000\nstarts = 9"), {"--changed"}).code != 2);
    StudyBench anew;
    (void)anew.run(reliability_text("samples = 20000\nstarts = 9"));
    CHECK(bench.samples() == anew.samples());
  }
  SUBCASE("another limit state is another study") {
    std::string other = reliability_text();
    other.replace(other.find("2.5 -"), 5, "2.4 -");
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--changed"}}) {
      const Outcome outcome = bench.run(other, more);
      CHECK(outcome.code == 2);
      CHECK(has(outcome.err, "another study"));
    }
    CHECK(bench.samples() == before);
    CHECK(bench.run(other, {"--restart"}).code != 2);
    CHECK(bench.samples() != before);
  }
}

TEST_CASE("stores that cannot be used are told, and left as they are") {
  StudyBench bench;
  const std::string file = bench.write("study.toml", reliability_text());
  SUBCASE("no store yet") { CHECK(has(study_does({"show", bench.at("none.sqlite")}).err, "there is no store")); }
  SUBCASE("not a store") {
    const std::string other = bench.write("letter.sqlite", "Dear Sir or Madam, this is longer than a page head of a database, and more.");
    const Outcome outcome = study_does({"run", file, "-o", other, "--restart"});
    CHECK(outcome.code == 2);
    CHECK(has(outcome.err, "no store of a study"));
    CHECK(text_of(other).starts_with("Dear Sir"));
  }
  SUBCASE("another process writes to it") {
    (void)bench.run(reliability_text());
    const int held = open(bench.at("study.sqlite").c_str(), O_RDWR);
    REQUIRE(flock(held, LOCK_EX | LOCK_NB) == 0);
    const Outcome outcome = study_does({"run", file, "-o", bench.at("study.sqlite")});
    CHECK(outcome.code == 2);
    CHECK(has(outcome.err, "another process is writing"));
    CHECK(study_does({"show", bench.at("study.sqlite")}).code == 0); // readers are welcome
    close(held);
  }
  SUBCASE("made by another version, or of another layout") {
    (void)bench.write("study.toml", reliability_text());
    study::StoreIdentity older = study::identity_of(study::read_study(file));
    older.version = "0.0.1";
    const std::string path = bench.at("older.sqlite");
    { study::Store(path, older, study::StoreMode::run).flush(); }
    Outcome outcome = study_does({"run", file, "-o", path});
    CHECK(outcome.code == 2);
    CHECK(has(outcome.err, "was made by version 0.0.1"));
    std::fstream bytes(path, std::ios::binary | std::ios::in | std::ios::out);
    bytes.seekp(60); // of an SQLite file's head: the user's version, most significant byte first
    bytes.write("\0\0\0\x63", 4);
    bytes.close();
    const std::string before = text_of(path);
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"run", file, "-o", path}, {"show", path}, {"run", file, "-o", path, "--restart"}}) {
      outcome = study_does(arguments);
      CHECK(outcome.code == 2);
      CHECK(has(outcome.err, "layout 99"));
    }
    CHECK(text_of(path) == before);
  }
  SUBCASE("no file at all") {
    const Outcome outcome = study_does({"run", file, "-o", "/dev/full"});
    CHECK(outcome.code == 2);
    CHECK(has(outcome.err, "is no file"));
  }
  SUBCASE("the disk is full: what was finished before is kept") {
    StudyBench whole;
    (void)whole.run(reliability_text());
    // A shell's limit on the size of files stands for the end of the disk; blocks of 1024 bytes.
    const std::string command = std::string("trap '' XFSZ; ulimit -f 800; ") + STEPLAP_PROGRAM + " study " + file + " -o " +
                                bench.at("study.sqlite") + " 2> " + bench.at("said");
    CHECK(wait_for(start({"bash", "-c", command})) == 2);
    CHECK(has(text_of(bench.at("said")), "disk is full"));
    (void)bench.run(reliability_text());
    CHECK(bench.samples() == whole.samples());
  }
}
