#include "mbd/base/budget.h"
#include "mbd/run/results.h"
#include "tools/pages/report_page.h"
#include "tools/python/bindings.h"
#include "tools/python/pickling.h"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace steplap::python {

// Pickles the members of a run as data. The contents of files are included, because another version of steplap could write different ones.
template <> struct MemberPickle<std::shared_ptr<const Columns>> {
  static py::object state(const std::shared_ptr<const Columns>& columns) {
    return py::make_tuple(columns->names, columns->units, py::cast(columns->values));
  }
  static void restore(std::shared_ptr<const Columns>& columns, const py::handle& state) {
    const auto parts = state.cast<py::tuple>();
    columns = std::make_shared<const Columns>(
        Columns{parts[0].cast<std::vector<std::string>>(), parts[1].cast<std::vector<std::string>>(), parts[2].cast<MatX>()});
  }
};

template <> struct MemberPickle<std::function<std::string()>> {
  static py::object state(const std::function<std::string()>& made) { return py::str(made()); }
  static void restore(std::function<std::string()>& made, const py::handle& state) {
    made = [text = state.cast<std::string>()] { return text; };
  }
};

template <> struct MemberPickle<std::function<std::vector<ResultFile>()>> {
  static py::object state(const std::function<std::vector<ResultFile>()>& made) {
    py::list all;
    for (const ResultFile& file : made()) {
      std::string content = file.content;
      if (file.parts) file.parts([&content](std::string_view part) { content += part; });
      all.append(py::make_tuple(file.name, py::bytes(content)));
    }
    return all;
  }
  static void restore(std::function<std::vector<ResultFile>()>& made, const py::handle& state) {
    std::vector<ResultFile> files;
    for (const py::handle file : state) {
      const auto parts = file.cast<py::tuple>();
      files.push_back({parts[0].cast<std::string>(), parts[1].cast<std::string>()});
    }
    made = [files = std::move(files)] { return files; };
  }
};

namespace {

// Returns a read-only array that refers to the block without copying and keeps it alive.
py::array inspect(const std::shared_ptr<const Columns>& columns, py::ssize_t first, py::ssize_t count, bool is_flat) {
  const auto* const owner = new std::shared_ptr<const Columns>(columns);
  const py::capsule keeper(owner, [](void* held) { delete static_cast<const std::shared_ptr<const Columns>*>(held); });
  const auto rows = static_cast<py::ssize_t>(columns->values.rows());
  const auto size = static_cast<py::ssize_t>(sizeof(double));
  const double* const data = columns->values.data() + first * rows; // columns are stored one after the other
  py::array array = is_flat
                        ? py::array(py::dtype::of<double>(), std::vector<py::ssize_t>{rows}, std::vector<py::ssize_t>{size}, data, keeper)
                        : py::array(py::dtype::of<double>(), std::vector<py::ssize_t>{rows, count},
                                    std::vector<py::ssize_t>{size, size * rows}, data, keeper);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array series(const PyRun& run, const std::string& name) {
  const auto found = std::find(run.columns->names.begin(), run.columns->names.end(), name);
  if (found == run.columns->names.end())
    throw py::key_error("no channel '" + name + "' is written" + did_you_mean(name, run.columns->names));
  return inspect(run.columns, found - run.columns->names.begin(), 1, true);
}

py::dict extremes(const PyRun& run, const std::string& name) {
  const auto found = std::find_if(run.extremes.begin(), run.extremes.end(), [&](const auto& one) { return one.first == name; });
  if (found == run.extremes.end()) throw py::key_error("there are no extremes of a channel '" + name + "'");
  py::dict all;
  for (std::size_t i = 0; i < k_extremes.size(); ++i) all[k_extremes[i]] = found->second[i];
  return all;
}

PyRun shown(const std::shared_ptr<const Report>& report) {
  PyRun run;
  run.path = report->run.loaded->path;
  run.name = report->run.loaded->name;
  run.verdict = name_of(report->judgement.verdict);
  run.distrust = report->judgement.distrust;
  run.caps = report->judgement.caps;
  run.criteria = report->judgement.criteria;
  run.findings = report->findings;
  run.energy_residual = report->relative_energy_residual;
  for (const Event& event : report->run.result.events) run.events.push_back({event.t, event.element, event.words()});
  if (report->run.failure) run.failure = report->run.failure->text;
  for (const ChannelRange& range : report->ranges())
    run.extremes.emplace_back(range.channel->name,
                              PyExtremes{range.low.value, range.low.t, range.high.value, range.high.t, range.first, range.final,
                                         report->error_of(range, &ChannelError::low), report->error_of(range, &ChannelError::high)});
  run.columns = std::make_shared<const Columns>(report->columns());
  run.json = [report] { return report->json(); };
  run.files = [report] { return result_files(*report); };
  return run;
}

PyRun run_of(const PyModel& model, std::optional<std::string> method, std::optional<double> tolerance, std::optional<double> step,
             std::optional<double> end, std::optional<double> output_step, const std::string& estimate, bool second_opinion,
             std::optional<double> time_limit, std::optional<double> memory_limit) {
  if (time_limit && !(*time_limit > 0.0)) throw py::value_error("time_limit: seconds, more than zero");
  if (memory_limit && !(*memory_limit > 0.0)) throw py::value_error("memory_limit: bytes, more than zero");
  RunOptions options;
  options.method = std::move(method);
  options.tolerance = tolerance;
  options.step = step;
  options.end = end;
  options.output_step = output_step;
  options.estimating = estimating_named(estimate);
  options.has_second_opinion = second_opinion;
  return computed([&](const StopQuestion& stop) {
    options.stop = within({time_limit, memory_limit}, stop);
    return shown(std::make_shared<const Report>(judged_run(model.loaded, options)));
  });
}

// Returns the page, which is created from the results as they would be read from a folder.
std::string page_of(const PyRun& run) {
  namespace fs = std::filesystem;
  std::string folder = (fs::temp_directory_path() / "steplap-XXXXXX").string();
  if (!mkdtemp(folder.data())) throw FileError(folder, "no temporary folder can be made");
  struct FolderRemover {
    std::string folder;
    ~FolderRemover() {
      std::error_code ignored;
      fs::remove_all(folder, ignored);
    }
  } const remover{folder};
  const std::string results = folder + "/" + run.name;
  write_results(results, run.files(), false);
  return report_page({read_results(results)});
}

void add_criterion_and_event(py::module_& module) {
  native_class<CriterionResult>(module, "Criterion", "What became of one criterion.")
      .def_readonly("name", &CriterionResult::name)
      .def_readonly("text", &CriterionResult::text, "what is asked")
      .def_readonly("reason", &CriterionResult::reason, "why it is asked")
      .def_property_readonly(
          "outcome", [](const CriterionResult& c) { return name_of(c.outcome); }, "'hold', 'open', 'inspect' or 'reject'")
      .def_readonly("value", &CriterionResult::value, "nearest to its limit, or furthest beyond, SI; None: no value")
      .def_readonly("limit", &CriterionResult::limit, "SI")
      .def_readonly("unit", &CriterionResult::unit)
      .def_readonly("t", &CriterionResult::t, "s, of that value")
      .def_readonly("error", &CriterionResult::error, "of the value; None or not-a-number: unknown")
      .def_readonly("doubt", &CriterionResult::doubt)
      .def(pickling_of(&CriterionResult::name, &CriterionResult::text, &CriterionResult::reason, &CriterionResult::consequence,
                       &CriterionResult::outcome, &CriterionResult::where, &CriterionResult::value, &CriterionResult::limit,
                       &CriterionResult::t, &CriterionResult::unit, &CriterionResult::channel, &CriterionResult::reserve,
                       &CriterionResult::error, &CriterionResult::t_error, &CriterionResult::doubt))
      .def("__repr__", [](const CriterionResult& c) { return c.name + ", " + c.text + ": " + name_of(c.outcome); });
  native_class<PyEvent>(module, "Event", "Something that happened at one instant.")
      .def_readonly("t", &PyEvent::t, "s")
      .def_readonly("element", &PyEvent::element)
      .def_readonly("words", &PyEvent::words, "'slips', 'closes', ...")
      .def(pickling_of(&PyEvent::t, &PyEvent::element, &PyEvent::words))
      .def("__repr__", [](const PyEvent& e) { return std::to_string(e.t) + " s: " + e.element + " " + e.words; });
}

} // namespace

Estimating estimating_named(const std::string& name) {
  if (name == "never") return Estimating::never;
  if (name == "cheap") return Estimating::cheap;
  if (name == "always") return Estimating::always;
  throw py::value_error("estimate: 'never', 'cheap' or 'always', not '" + name + "'");
}

void add_run(py::module_& module) {
  add_criterion_and_event(module);
  native_class<PyRun>(module, "Run", "A run with all that is known about it. run['tank.x'] is a channel as an array.")
      .def_readonly("verdict", &PyRun::verdict, "'hold', 'open', 'inspect' or 'reject'")
      .def_readonly("distrust", &PyRun::distrust, "not empty: why the run is not to be trusted")
      .def_readonly("caps", &PyRun::caps, "why the run cannot mean 'hold', whatever it meets")
      .def_readonly("criteria", &PyRun::criteria)
      .def_readonly("findings", &PyRun::findings)
      .def_readonly("energy_residual", &PyRun::energy_residual,
                    "what the energy account does not close by, as a share of the energy exchanged")
      .def_readonly("events", &PyRun::events, "ascending in time")
      .def_readonly("failure", &PyRun::failure, "why it ended before its end; None: it did not")
      .def_property_readonly(
          "names", [](const PyRun& r) { return r.columns->names; }, "'t', then the channels written")
      .def_property_readonly(
          "units", [](const PyRun& r) { return r.columns->units; }, "SI, of names")
      .def_property_readonly(
          "values", [](const PyRun& r) { return inspect(r.columns, 0, static_cast<py::ssize_t>(r.columns->values.cols()), false); },
          "all samples: shape (rows, names), SI, not copied, read only")
      .def_property_readonly(
          "t", [](const PyRun& r) { return inspect(r.columns, 0, 1, true); }, "s, shape (rows,)")
      .def("__getitem__", series, py::arg("channel"), "A channel: shape (rows,), SI, not copied. Raises KeyError.")
      .def(
          "__len__", [](const PyRun& r) { return r.columns->values.rows(); }, "Number of rows, as of a data frame.")
      .def(
          "__iter__", [](const PyRun& r) { return py::iter(py::cast(r.columns->names)); }, "The names of the columns, as of a data frame.")
      .def(
          "keys", [](const PyRun& r) { return r.columns->names; }, "`names`, so that dict(run) has all columns.")
      .def(
          "__contains__",
          [](const PyRun& r, const std::string& channel) {
            return std::find(r.columns->names.begin(), r.columns->names.end(), channel) != r.columns->names.end();
          },
          py::arg("channel"), "Is there such a column?")
      .def("extremes", extremes, py::arg("channel"),
           "Least and largest value of the whole run, whatever the output step, with times (s), first and final value and estimated errors "
           "(None: unknown).")
      .def(
          "json", [](const PyRun& r) { return r.json(); }, "the text of summary.json")
      .def(
          "write",
          [](const PyRun& r, const std::filesystem::path& folder, bool overwrite) {
            const Unlocked unlocked;
            write_results(folder.string(), r.files(), overwrite);
          },
          py::arg("folder"), py::arg("overwrite") = false, "All files of the run, as the program writes them, or none. Raises FileError.")
      .def("page", page_of, "The page of the run: one HTML text that needs no other file.")
      .def(pickling_of(&PyRun::path, &PyRun::name, &PyRun::verdict, &PyRun::distrust, &PyRun::caps, &PyRun::criteria, &PyRun::findings,
                       &PyRun::energy_residual, &PyRun::events, &PyRun::failure, &PyRun::extremes, &PyRun::columns, &PyRun::json,
                       &PyRun::files))
      .def("__repr__", [](const PyRun& r) { return "<steplap.Run of " + r.path + ": " + r.verdict + ">"; });
  module.attr("Model").attr("run") = py::cpp_function(
      run_of, py::name("run"), py::is_method(module.attr("Model")), py::arg("method") = py::none(), py::arg("tolerance") = py::none(),
      py::arg("step") = py::none(), py::arg("end") = py::none(), py::arg("output_step") = py::none(), py::arg("estimate") = "cheap",
      py::arg("second_opinion") = false, py::arg("time_limit") = py::none(), py::arg("memory_limit") = py::none(),
      "Runs the model and judges the run, as `steplap simulate` does. What is not given is as the model says. "
      "Other Python threads continue meanwhile; Ctrl-C ends it. `time_limit`: s, `memory_limit`: bytes of the "
      "process; beyond either, `failure` says so and the verdict is open.");
}

} // namespace steplap::python
