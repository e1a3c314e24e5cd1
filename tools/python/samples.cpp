#include "mbd/base/limits.h"
#include "mbd/model/model_path.h"
#include "mbd/system/instance.h"
#include "tools/python/bindings.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

namespace steplap::python {

namespace {

constexpr double k_none = std::numeric_limits<double>::quiet_NaN();

// A number taken from each run: a channel and one of its values.
struct Response {
  std::string channel;
  enum class ResponseValue { low, high, first, final } which = ResponseValue::high;
};

Response response_of(const std::pair<std::string, std::string>& given, const System& system) {
  const auto& [channel, which] = given;
  std::vector<std::string> known;
  for (const Channel& c : system.channels) known.push_back(c.name);
  if (std::find(known.begin(), known.end(), channel) == known.end())
    throw py::value_error("there is no channel '" + channel + "'" + did_you_mean(channel, known));
  if (which == "low") return {channel, Response::ResponseValue::low};
  if (which == "high") return {channel, Response::ResponseValue::high};
  if (which == "first") return {channel, Response::ResponseValue::first};
  if (which == "final") return {channel, Response::ResponseValue::final};
  throw py::value_error("of '" + channel + "': 'low', 'high', 'first' or 'final', not '" + which + "'");
}

double value_in(const Report& report, const Response& response) {
  const ChannelRange* const range = report.find(response.channel);
  if (!range) return k_none;
  switch (response.which) {
  case Response::ResponseValue::low: return range->low.value;
  case Response::ResponseValue::high: return range->high.value;
  case Response::ResponseValue::first: return range->first;
  case Response::ResponseValue::final: return range->final;
  }
  return k_none;
}

// Samples of one call, shared by its worker threads. work() runs samples that no other thread has taken, with the thread's own copy of the
// model.
struct Crew {
  const Model& given;
  const std::string& path;
  const std::vector<std::string>& paths;
  const std::vector<Response>& responses;
  const double* values;
  std::size_t count;
  double* results;
  std::vector<std::string>& verdicts;
  std::vector<std::string>& troubles;
  std::atomic<std::size_t> next{0}, done{0};
  std::atomic<bool> is_stopped{false};

  void work() {
    Variants variants(given, paths);
    for (std::size_t i = next++; i < count && !is_stopped; i = next++) {
      run(variants, i);
      ++done;
    }
  }

  void run(Variants& variants, std::size_t i) {
    double* const row = results + i * responses.size();
    std::fill(row, row + responses.size(), k_none);
    try {
      RunOptions options;
      options.estimating = Estimating::never;
      options.stop = [this] { return is_stopped ? std::string("interrupted") : std::string(); };
      std::shared_ptr<const System> system = variants.make(std::vector<double>(values + i * paths.size(), values + (i + 1) * paths.size()));
      const Report report = judged_run(load_completed(variants.model(), std::move(system), path), options);
      verdicts[i] = name_of(report.judgement.verdict);
      troubles[i] = report.run.failure ? report.run.failure->text : report.judgement.distrust;
      if (!report.run.failure)
        for (std::size_t k = 0; k < responses.size(); ++k) row[k] = value_in(report, responses[k]);
    } catch (const std::exception& error) { // the values are invalid, or there is no initial state
      verdicts[i] = name_of(Verdict::open);
      troubles[i] = error.what();
    }
  }
};

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

py::tuple samples(const PyModel& model, const std::vector<std::string>& paths, const Numbers& values,
                  const std::vector<std::pair<std::string, std::string>>& wanted, int threads) {
  if (values.ndim() != 2 || values.shape(1) != static_cast<py::ssize_t>(paths.size()))
    throw py::value_error("values: an array of shape (samples, " + std::to_string(paths.size()) + "), a column a path");
  std::vector<Response> responses;
  for (const auto& one : wanted) responses.push_back(response_of(one, *model.loaded->system));
  const auto count = static_cast<std::size_t>(values.shape(0));
  Numbers results({count, responses.size()});
  std::vector<std::string> verdicts(count), troubles(count);
  const Model given = given_model(model);
  for (const std::string& path : paths) static_cast<void>(number_of(given, path)); // checks the paths before threads start
  Crew crew{given, model.loaded->path, paths, responses, values.data(), count, results.mutable_data(), verdicts, troubles};
  if (threads > k_most_threads) throw std::invalid_argument("'threads' may be at most " + std::to_string(k_most_threads));
  Interruption interruption;
  {
    const py::gil_scoped_release unlocked;
    const auto most = std::max(1U, threads > 0 ? static_cast<unsigned>(threads) : std::thread::hardware_concurrency());
    std::vector<std::thread> team;
    for (std::size_t k = 0; k < std::min<std::size_t>(most, count); ++k) team.emplace_back([&crew] { crew.work(); });
    while (crew.done < count && !crew.is_stopped) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (!interruption.ask().empty()) crew.is_stopped = true;
    }
    for (std::thread& thread : team) thread.join();
  }
  interruption.raise_if_any();
  return py::make_tuple(results, verdicts, troubles);
}

} // namespace

void add_samples(py::module_& module) {
  module.attr("Model").attr("samples") = py::cpp_function(
      samples, py::name("samples"), py::is_method(module.attr("Model")), py::arg("paths"), py::arg("values"), py::arg("responses"),
      py::arg("threads") = 0,
      "Runs the model with many values side by side. `paths`: what varies; `values`: shape (samples, paths), SI; `responses`: (channel, "
      "'low' | 'high' | 'first' | "
      "'final'). Returns the responses, shape (samples, responses), not-a-number where a run did not reach its end; the verdict of each "
      "run, without estimated errors; "
      "and what is wrong with it, '' if nothing is. The numbers do not hang on `threads` (0: all processors). Ctrl-C ends it.");
}

} // namespace steplap::python
