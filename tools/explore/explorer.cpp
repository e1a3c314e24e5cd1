#include "tools/explore/explorer.h"

#include "mbd/run/overview.h"
#include "tools/explore/explore_json.h"
#include "tools/explore/run_results.h"
#include "tools/explore/saved_changes.h"
#include "tools/pages/explore/assets.h"
#include "tools/pages/report_page.h"

#include <algorithm>
#include <stdexcept>

namespace steplap {

namespace {

using Clock = std::chrono::steady_clock;

// Content-Security-Policy of the page: scripts and styles from this server only. Style attributes are allowed because scripts set them.
constexpr const char* k_page_policy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; img-src 'self' data: blob:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
// Policy of a report, which is one file with inline scripts. The sandbox gives it a separate origin, from which the gate refuses requests.
constexpr const char* k_report_policy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'; sandbox allow-scripts allow-downloads allow-modals";

Diagnostic problem_at(const std::string& file, const std::string& message) {
  Diagnostic problem;
  problem.where.file = file;
  problem.message = message;
  return problem;
}

PageReply json_reply(std::string text) { return {200, "application/json", std::move(text)}; }
PageReply plain_reply(int status, const std::string& text) { return {status, "text/plain; charset=utf-8", text + "\n"}; }

// Runs `work`. Invalid values become errors in the reply; other exceptions are bugs and become an error, too.
PageReply guarded(const std::function<PageReply()>& work) {
  try {
    return work();
  } catch (const RunStopped&) {
    return json_reply(superseded_json());
  } catch (const ModelError& error) {
    return json_reply(errors_json(error.diagnostics()));
  } catch (const std::exception& error) {
    return json_reply(errors_json(std::vector<Diagnostic>(1, problem_at("", error.what()))));
  }
}

RunOptions options_for(const WorkQueue::IsStale& is_stale, Estimating estimating) {
  RunOptions options;
  options.estimating = estimating;
  options.stop = [is_stale] { return is_stale() ? std::string("newer values were requested") : std::string(); };
  return options;
}

PageReply run_reply(ExploredModel& model, const RunRequest& asked, const WorkQueue::IsStale& is_stale, long version) {
  if (is_stale()) return json_reply(superseded_json());
  const Report report = model.run(asked.values, options_for(is_stale, asked.is_settled ? Estimating::cheap : Estimating::never));
  if (is_stale()) return json_reply(superseded_json());
  return json_reply(run_json(report, version, Explorer::k_drag_budget));
}

// Runs the cells of a map in order until the time limit or a more urgent request, and returns the results so far.
PageReply map_reply(ExploredModel& model, const MapRequest& asked, const WorkQueue::IsStale& is_stale) {
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(Explorer::k_map_seconds));
  std::vector<MapCell> cells;
  for (const auto& [x, y] : asked.cells) {
    if (is_stale() || Clock::now() > end) break;
    ExploredValues values = asked.values;
    values[asked.x] = x;
    values[asked.y] = y;
    MapCell cell;
    try {
      const Overview overview = overview_of(model.run(values, options_for(is_stale, Estimating::never)));
      cell.verdict = name_of(overview.verdict);
      for (const Utilisation& u : overview.utilisations) cell.shares.emplace_back(u.name, u.share);
    } catch (const ModelError& error) {
      cell.error = error.diagnostics().empty() ? error.what() : error.diagnostics().front().message;
    } catch (const NumericalFailure& failure) {
      cell.error = failure.what();
    }
    if (is_stale()) break; // the interrupted run has no valid result
    cells.push_back(std::move(cell));
  }
  return json_reply(map_json(cells));
}

PageReply report_reply(const ExploredModel& model, const RunRequest& asked, const WorkQueue::IsStale& is_stale) {
  try {
    if (is_stale()) throw RunStopped("the page was closed");
    const Report report = model.run_from_file(asked.values, options_for(is_stale, Estimating::cheap));
    PageReply reply;
    reply.type = "text/html; charset=utf-8";
    reply.body = report_page({results_of(report)});
    reply.policy = k_report_policy;
    return reply;
  } catch (const std::exception& error) {
    return plain_reply(200, std::string("There is no report: ") + error.what());
  }
}

PageReply asset_reply(const char* type, std::string_view text) {
  PageReply reply{200, type, std::string(text)};
  reply.policy = k_page_policy;
  return reply;
}

} // namespace

Explorer::Explorer(const std::vector<std::string>& paths, const std::vector<std::string>& overrides) {
  std::vector<Diagnostic> problems;
  for (const std::string& path : paths) {
    models_.push_back(std::make_unique<WatchedModel>(WatchedModel{ExploredModel(path, overrides), "", {}}));
    WatchedModel& one = *models_.back();
    try {
      one.model.read();
      one.state = model_state_json(one.model, {});
      one.watch.watch(one.model.files());
    } catch (const ModelError& error) {
      problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  }
  if (!problems.empty()) throw ModelError(std::move(problems));
  queue_ = std::make_unique<WorkQueue>();
}

Explorer::~Explorer() { end(); }

void Explorer::end() {
  queue_.reset();
  waiting_.clear();
}

std::string Explorer::state_text() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> states;
  for (const auto& one : models_) states.push_back(one->state);
  return state_json(version_, states);
}

void Explorer::read_again(std::size_t k) {
  {
    const std::lock_guard lock(mutex_);
    if (models_[k]->is_reading) return;
    models_[k]->is_reading = true;
  }
  const bool is_taken = queue_->add(WorkQueue::Urgency::page, "", [this, k](const WorkQueue::IsStale&) {
    WatchedModel& one = *models_[k];
    std::vector<Diagnostic> problems;
    try {
      one.model.read();
    } catch (const ModelError& error) {
      problems = error.diagnostics();
    } catch (const std::exception& error) {
      problems.assign(1, problem_at(one.model.path(), error.what()));
    }
    std::string state = model_state_json(one.model, problems);
    const std::lock_guard lock(mutex_);
    one.state = std::move(state);
    one.files_read = one.model.files();
    one.has_read = true;
    one.is_reading = false;
    ++version_;
  });
  if (is_taken) return;
  const std::lock_guard lock(mutex_);
  models_[k]->is_reading = false;
}

void Explorer::tick() {
  for (std::size_t k = 0; k < models_.size(); ++k) {
    WatchedModel& one = *models_[k];
    {
      const std::lock_guard lock(mutex_);
      if (one.is_reading) continue;
      if (one.has_read && one.files_read != one.watched) {
        one.watched = one.files_read;
        one.watch.watch(one.watched);
      }
      one.has_read = false;
    }
    if (one.watch.has_changed()) read_again(k);
  }
  long version = 0;
  {
    const std::lock_guard lock(mutex_);
    version = version_;
  }
  const auto now = Clock::now();
  const auto is_due = [&](const WaitingRequest& w) { return *w.is_gone || w.since != version || now > w.until; };
  for (WaitingRequest& w : waiting_)
    if (is_due(w)) w.send(json_reply(state_text()));
  std::erase_if(waiting_, is_due);
}

void Explorer::answer_state(const PageRequest& request, const SendReply& send) {
  long since = 0;
  if (request.query.starts_with("since=")) since = std::atol(request.query.c_str() + 6);
  bool is_new = false;
  {
    const std::lock_guard lock(mutex_);
    is_new = since != version_;
  }
  if (is_new || waiting_.size() >= 32) return send(json_reply(state_text()));
  waiting_.push_back({since, Clock::now() + std::chrono::seconds(k_longest_wait), request.is_gone, send});
}

void Explorer::do_later(WorkQueue::Urgency urgency, const std::string& owner, const PageRequest& request, const SendReply& send,
                        std::function<PageReply(const WorkQueue::IsStale&)> work) {
  const bool is_taken =
      queue_->add(urgency, owner, [send, is_gone = request.is_gone, work = std::move(work)](const WorkQueue::IsStale& is_stale) {
        send(guarded([&] { return work([&] { return *is_gone || is_stale(); }); }));
      });
  if (!is_taken) send(plain_reply(503, "Too much is waiting."));
}

void Explorer::answer_post(const PageRequest& request, const SendReply& send) {
  if (request.path == "run") {
    const RunRequest asked = run_request(request.body, models_.size());
    return do_later(WorkQueue::Urgency::drag, asked.page, request, send, [this, asked](const WorkQueue::IsStale& is_stale) {
      long version = 0;
      {
        const std::lock_guard lock(mutex_);
        version = version_;
      }
      return run_reply(models_[asked.model]->model, asked, is_stale, version);
    });
  }
  if (request.path == "cells") {
    const MapRequest asked = map_request(request.body, models_.size(), k_most_cells);
    return do_later(WorkQueue::Urgency::background, "", request, send,
                    [this, asked](const WorkQueue::IsStale& is_stale) { return map_reply(models_[asked.model]->model, asked, is_stale); });
  }
  if (request.path == "save") {
    const RunRequest asked = run_request(request.body, models_.size());
    return do_later(WorkQueue::Urgency::page, "", request, send, [this, asked](const WorkQueue::IsStale&) {
      return json_reply(saved_json(save_changes(models_[asked.model]->model, asked.values, asked.name)));
    });
  }
  send(plain_reply(404, "There is nothing of that name."));
}

void Explorer::answer_report(const PageRequest& request, const SendReply& send) {
  const RunRequest asked = report_request(request.query, models_.size());
  do_later(WorkQueue::Urgency::page, "", request, send,
           [this, asked](const WorkQueue::IsStale& is_stale) { return report_reply(models_[asked.model]->model, asked, is_stale); });
}

void Explorer::answer(const PageRequest& request, const SendReply& send) {
  if (!queue_) return;
  try {
    if (request.is_post) return answer_post(request, send);
    if (request.path.empty()) return send(asset_reply("text/html; charset=utf-8", explore_assets::k_explore_html));
    if (request.path == "page.js") return send(asset_reply("text/javascript; charset=utf-8", explore_assets::k_explore_js));
    if (request.path == "page.css") return send(asset_reply("text/css; charset=utf-8", explore_assets::k_explore_css));
    if (request.path == "state") return answer_state(request, send);
    if (request.path == "report") return answer_report(request, send);
    send(plain_reply(404, "There is nothing of that name."));
  } catch (const std::invalid_argument& error) {
    send(plain_reply(400, error.what()));
  } catch (const std::exception& error) {
    send(plain_reply(500, error.what()));
  }
}

} // namespace steplap
