#include "mbd/run/results.h"
#include "tools/pages/report_page.h"
#include "tools/python/bindings.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace steplap::python {

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
  const ChannelRange* const range = run.report->find(name);
  if (!range) throw py::key_error("there are no extremes of a channel '" + name + "'");
  py::dict all;
  all["low"] = range->low.value;
  all["t_low"] = range->low.t;
  all["high"] = range->high.value;
  all["t_high"] = range->high.t;
  all["first"] = range->first;
  all["final"] = range->final;
  const std::optional<double> low = run.report->error_of(*range, &ChannelError::low),
                              high = run.report->error_of(*range, &ChannelError::high);
  all["low_error"] = low;
  all["high_error"] = high;
  return all;
}

Estimating estimating_named(const std::string& name) {
  if (name == "never") return Estimating::never;
  if (name == "cheap") return Estimating::cheap;
  if (name == "always") return Estimating::always;
  throw py::value_error("estimate: 'never', 'cheap' or 'always', not '" + name + "'");
}

PyRun run_of(const PyModel& model, std::optional<std::string> method, std::optional<double> tolerance, std::optional<double> step,
             std::optional<double> end, std::optional<double> output_step, const std::string& estimate, bool second_opinion) {
  RunOptions options;
  options.method = std::move(method);
  options.tolerance = tolerance;
  options.step = step;
  options.end = end;
  options.output_step = output_step;
  options.estimating = estimating_named(estimate);
  options.has_second_opinion = second_opinion;
  Interruption interruption;
  options.stop = [&interruption] { return interruption.ask(); };
  PyRun run;
  {
    const py::gil_scoped_release unlocked;
    run.report = std::make_shared<const Report>(judged_run(model.loaded, options));
    run.columns = std::make_shared<const Columns>(run.report->columns());
  }
  interruption.raise_if_any();
  return run;
}

// The page is made from a folder of results, as by the command line.
std::string page_of(const PyRun& run) {
  namespace fs = std::filesystem;
  std::string folder = (fs::temp_directory_path() / "steplap-XXXXXX").string();
  if (!mkdtemp(folder.data())) throw FileError(folder, "no temporary folder can be made");
  struct Remover {
    std::string folder;
    ~Remover() {
      std::error_code ignored;
      fs::remove_all(folder, ignored);
    }
  } const remover{folder};
  const std::string results = folder + "/" + run.report->run.loaded->name;
  run.report->write(results);
  return report_page({read_results(results)});
}

void add_criterion_and_event(py::module_& module) {
  py::class_<CriterionResult>(module, "Criterion", "What became of one criterion.")
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
      .def("__repr__", [](const CriterionResult& c) { return c.name + ", " + c.text + ": " + name_of(c.outcome); });
  py::class_<Event>(module, "Event", "Something that happened at one instant.")
      .def_readonly("t", &Event::t, "s")
      .def_readonly("element", &Event::element)
      .def_property_readonly("words", &Event::words, "'slips', 'closes', ...")
      .def("__repr__", [](const Event& e) { return std::to_string(e.t) + " s: " + e.element + " " + e.words(); });
}

} // namespace

void add_run(py::module_& module) {
  add_criterion_and_event(module);
  py::class_<PyRun>(module, "Run", "A run with all that is known about it. run['tank.x'] is a channel as an array.")
      .def_property_readonly(
          "verdict", [](const PyRun& r) { return name_of(r.report->judgement.verdict); }, "'hold', 'open', 'inspect' or 'reject'")
      .def_property_readonly(
          "distrust", [](const PyRun& r) { return r.report->judgement.distrust; }, "not empty: why the run is not to be trusted")
      .def_property_readonly(
          "caps", [](const PyRun& r) { return r.report->judgement.caps; }, "why the run cannot mean 'hold', whatever it meets")
      .def_property_readonly("criteria", [](const PyRun& r) { return r.report->judgement.criteria; })
      .def_property_readonly("findings", [](const PyRun& r) { return r.report->findings; })
      .def_property_readonly(
          "energy_residual", [](const PyRun& r) { return r.report->relative_energy_residual; },
          "what the energy account does not close by, as a share of the energy exchanged")
      .def_property_readonly(
          "events", [](const PyRun& r) { return r.report->run.result.events; }, "ascending in time")
      .def_property_readonly(
          "failure",
          [](const PyRun& r) -> std::optional<std::string> {
            if (!r.report->run.failure) return std::nullopt;
            return r.report->run.failure->text;
          },
          "why it ended before its end; None: it did not")
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
      .def("__len__", [](const PyRun& r) { return r.columns->values.rows(); })
      .def("extremes", extremes, py::arg("channel"),
           "Least and largest value of the whole run, whatever the output step, with times (s), first and final value and estimated errors "
           "(None: unknown).")
      .def(
          "json", [](const PyRun& r) { return r.report->json(); }, "the text of summary.json")
      .def(
          "write",
          [](const PyRun& r, const std::string& folder, bool overwrite) {
            const py::gil_scoped_release unlocked;
            r.report->write(folder, overwrite);
          },
          py::arg("folder"), py::arg("overwrite") = false, "All files of the run, as the program writes them, or none. Raises FileError.")
      .def("page", page_of, "The page of the run: one HTML text that needs no other file.")
      .def("__repr__", [](const PyRun& r) {
        return "<steplap.Run of " + r.report->run.loaded->path + ": " + name_of(r.report->judgement.verdict) + ">";
      });
  module.attr("Model").attr("run") =
      py::cpp_function(run_of, py::name("run"), py::is_method(module.attr("Model")), py::arg("method") = py::none(),
                       py::arg("tolerance") = py::none(), py::arg("step") = py::none(), py::arg("end") = py::none(),
                       py::arg("output_step") = py::none(), py::arg("estimate") = "cheap", py::arg("second_opinion") = false,
                       "Runs the model and judges the run, as `steplap simulate` does. What is not given is as the model says. Other "
                       "threads of Python go on meanwhile; Ctrl-C ends it.");
}

} // namespace steplap::python
