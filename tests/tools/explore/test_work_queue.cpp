// The order of tasks, and which of them are told that nobody wants them any more. A gate holds the queue's thread, so that no test
// hangs on time.
#include "tools/explore/file_watch.h"
#include "tools/explore/work_queue.h"

#include <doctest/doctest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <vector>

using namespace steplap;
using Urgency = WorkQueue::Urgency;

namespace {

// Keeps the thread of a queue busy until it is let go.
struct Busy {
  struct Signals {
    std::promise<void> began, may_end;
    std::future<void> has_begun = began.get_future(), is_released = may_end.get_future();
  };
  std::shared_ptr<Signals> signals = std::make_shared<Signals>(); ///< the task may still look at them when this object is gone
  explicit Busy(WorkQueue& queue) {
    REQUIRE(queue.add(Urgency::page, "", [shared = signals](const WorkQueue::IsStale&) {
      shared->began.set_value();
      shared->is_released.wait();
    }));
    signals->has_begun.wait();
  }
  void end() const { signals->may_end.set_value(); }
};

} // namespace

TEST_CASE("the most urgent task is done first, and of the same owner the newest alone is wanted") {
  std::string done;
  std::promise<void> last;
  WorkQueue queue;
  Busy busy(queue);
  const auto task = [&done](char name) {
    return [&done, name](const WorkQueue::IsStale& is_stale) { done += is_stale() ? static_cast<char>(name - 'a' + 'A') : name; };
  };
  REQUIRE(queue.add(Urgency::background, "", task('m')));
  REQUIRE(queue.add(Urgency::drag, "one", task('a')));
  REQUIRE(queue.add(Urgency::page, "", task('r')));
  REQUIRE(queue.add(Urgency::drag, "two", task('b')));
  REQUIRE(queue.add(Urgency::drag, "one", task('c')));
  REQUIRE(queue.add(Urgency::background, "", [&last](const WorkQueue::IsStale&) { last.set_value(); }));
  busy.end();
  last.get_future().wait();
  CHECK(done == "Abcrm"); // 'a' is told that 'c' has come, and answers; owners do not disturb each other
}

TEST_CASE("a task under way gives way") {
  WorkQueue queue;
  for (const Urgency urgency : {Urgency::drag, Urgency::background}) {
    std::promise<void> began, ended;
    REQUIRE(queue.add(urgency, "one", [&](const WorkQueue::IsStale& is_stale) {
      CHECK_FALSE(is_stale());
      began.set_value();
      while (!is_stale()) std::this_thread::yield(); // for ever, if it is never told
      ended.set_value();
    }));
    began.get_future().wait();
    std::promise<bool> newer;
    REQUIRE(queue.add(Urgency::drag, "one", [&newer](const WorkQueue::IsStale& is_stale) { newer.set_value(is_stale()); }));
    ended.get_future().wait();
    CHECK_FALSE(newer.get_future().get());
  }
}

TEST_CASE("a queue that ends throws away what waits and tells what runs") {
  bool was_run = false;
  std::promise<void> began;
  {
    WorkQueue queue;
    REQUIRE(queue.add(Urgency::page, "", [&began](const WorkQueue::IsStale& is_stale) {
      began.set_value();
      while (!is_stale()) std::this_thread::yield();
    }));
    began.get_future().wait();
    REQUIRE(queue.add(Urgency::page, "", [&was_run](const WorkQueue::IsStale&) { was_run = true; }));
  }
  CHECK_FALSE(was_run);
}

TEST_CASE("a queue takes so many tasks and no more") {
  WorkQueue queue;
  Busy busy(queue);
  for (std::size_t i = 0; i < WorkQueue::k_most_waiting; ++i) CHECK(queue.add(Urgency::background, "", [](const WorkQueue::IsStale&) {}));
  CHECK_FALSE(queue.add(Urgency::drag, "", [](const WorkQueue::IsStale&) {}));
  busy.end();
}

TEST_CASE("files that are changed, replaced or gone are noticed once, when they are quiet") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("steplap_watch_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const std::string file = (folder / "a.toml").string();
  const auto write = [](const std::string& where, const std::string& text) { std::ofstream(where) << text; };
  write(file, "a");
  FileWatch watch;
  watch.watch({file, (folder / "missing").string()});
  CHECK_FALSE(watch.has_changed());
  write(file, "longer");
  CHECK_FALSE(watch.has_changed()); // somebody may be writing
  CHECK(watch.has_changed());
  CHECK_FALSE(watch.has_changed());
  write((folder / "new").string(), "longer"); // the same size: another file in its place
  fs::rename(folder / "new", file);
  CHECK_FALSE(watch.has_changed());
  CHECK(watch.has_changed());
  fs::remove(file);
  CHECK_FALSE(watch.has_changed());
  watch.watch({file}); // a change not told yet is not forgotten
  CHECK(watch.has_changed());
  fs::remove_all(folder);
}
