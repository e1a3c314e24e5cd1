#include "mbd/base/limits.h"
#include "mbd/model/model_path.h"
#include "mbd/system/instance.h"
#include "tools/python/bindings.h"
#include "transformer/program.h"

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

// A number to be taken from each run: one value of a channel.
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

// A value with its error estimate; the error is NaN if unknown.
struct Answer {
  double value = k_none, error = k_none;
};

Answer answer_of(const Report& report, const Response& response) {
  const ChannelRange* const range = report.find(response.channel);
  if (!range) return {};
  const auto error = [&](double ChannelError::*which) { return report.error_of(*range, which).value_or(k_none); };
  switch (response.which) {
  case Response::ResponseValue::low: return {range->low.value, error(&ChannelError::low)};
  case Response::ResponseValue::high: return {range->high.value, error(&ChannelError::high)};
  case Response::ResponseValue::first: return {range->first, k_none};
  case Response::ResponseValue::final: return {range->final, error(&ChannelError::final)};
  }
  return {};
}

// Samples shared by several worker threads. Each thread calls work(), which runs samples that no other thread has taken, with a copy of the
// model.
struct SampleQueue {
  const Model& given;
  const std::string& path;
  const std::vector<std::string>& paths;
  const std::vector<Response>& responses;
  const double* values;
  std::size_t count;
  Estimating estimating;
  double* results; ///< one row per sample: values, then their errors
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
    const std::size_t width = responses.size();
    double* const row = results + 2 * i * width;
    std::fill(row, row + 2 * width, k_none);
    try {
      RunOptions options;
      options.estimating = estimating;
      options.stop = [this] { return is_stopped ? std::string("interrupted") : std::string(); };
      std::shared_ptr<const System> system = variants.make(std::vector<double>(values + i * paths.size(), values + (i + 1) * paths.size()));
      const Report report = judged_run(load_completed(variants.model(), std::move(system), path), options);
      verdicts[i] = name_of(report.judgement.verdict);
      troubles[i] = report.run.failure ? report.run.failure->text : report.judgement.distrust;
      if (!report.run.failure)
        for (std::size_t k = 0; k < width; ++k) {
          const Answer answer = answer_of(report, responses[k]);
          row[k] = answer.value;
          row[width + k] = answer.error;
        }
    } catch (const std::exception& error) { // the values are invalid, or there is no initial state
      verdicts[i] = name_of(Verdict::open);
      troubles[i] = error.what();
    }
  }
};

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

py::tuple samples(const PyModel& model, const std::vector<std::string>& paths, const Numbers& values,
                  const std::vector<std::pair<std::string, std::string>>& wanted, int threads, const std::string& estimate) {
  if (values.ndim() != 2 || values.shape(1) != static_cast<py::ssize_t>(paths.size()))
    throw py::value_error("values: an array of shape (samples, " + std::to_string(paths.size()) + "), a column a path");
  std::vector<Response> responses;
  for (const auto& one : wanted) responses.push_back(response_of(one, *model.loaded->system));
  const auto count = static_cast<std::size_t>(values.shape(0));
  Numbers results({count, 2 * responses.size()});
  std::vector<std::string> verdicts(count), troubles(count);
  const Model given = given_model(model);
  for (const std::string& path : paths) static_cast<void>(number_of(given, path)); // checks the paths before threads start
  SampleQueue crew{
      given,   model.loaded->path, paths, responses, values.data(), count, estimating_named(estimate), results.mutable_data(), verdicts,
      troubles};
  if (threads > k_most_threads) throw std::invalid_argument("'threads' may be at most " + std::to_string(k_most_threads));
  computed([&](const StopQuestion& stop) {
    const auto most = std::max(1U, threads > 0 ? static_cast<unsigned>(threads) : std::thread::hardware_concurrency());
    std::vector<std::jthread> team;
    for (std::size_t k = 0; k < std::min<std::size_t>(most, count); ++k) team.emplace_back([&crew] { crew.work(); });
    while (crew.done < count && !crew.is_stopped) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (!stop().empty()) crew.is_stopped = true;
    }
    return true;
  });
  return py::make_tuple(results, verdicts, troubles);
}

} // namespace

void add_samples(py::module_& module) {
  module.def(
      "_samples", samples, py::arg("model"), py::arg("paths"), py::arg("values"), py::arg("responses"), py::arg("threads"),
      py::arg("estimate"),
      "Runs the model once a row of `values`. Returns a row of responses, followed by their errors, for each; verdicts and troubles.");
}

} // namespace steplap::python
