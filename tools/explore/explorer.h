// What stands behind the page of `steplap explore`: models, runs of them, a map, changes saved, files watched.
//
// Paths behind the token, and what they answer. All JSON; numbers in SI.
//   ""               the page
//   page.js page.css its script and its style
//   state?since=N    GET   the models with their sliders and errors, at once if the version is not N, else when it changes or after a while
//   run              POST  {"model", "values": {path: number}, "page", "is_settled"}: {"version", "data": what report_data() gives of the run}
//                          or {"errors"} or {"is_superseded": true}
//   cells            POST  {"model", "values", "x", "y", "cells": [[x, y], …]}: {"cells": [{"verdict", "shares": {name: share}} or {"error"}, …]},
//                          fewer than asked for if something more urgent came, or time is up
//   save             POST  {"model", "values", "name"}: {"file"} or {"errors"}
//   report?model=K&values={…}  GET  the page of that run
// Errors are [{"file", "line", "column", "message"}].
#pragma once

#include "tools/explore/explored_model.h"
#include "tools/explore/file_watch.h"
#include "tools/explore/request.h"
#include "tools/explore/work_queue.h"

#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace steplap {

/// Answers the requests of pages. Its own thread does the work.
class Explorer {
public:
  static constexpr double k_map_seconds = 0.2;         ///< computing for one request for a map
  static constexpr std::size_t k_most_cells = 400;     ///< of one request for a map
  static constexpr std::size_t k_drag_budget = 300000; ///< bytes of curves in the answer to a run
  static constexpr int k_longest_wait = 20;            ///< s, of a request for the state

  /// Reads the models. Throws ModelError with all that is wrong with any of them.
  Explorer(const std::vector<std::string>& paths, const std::vector<std::string>& overrides);
  ~Explorer();
  Explorer(const Explorer&) = delete;
  Explorer& operator=(const Explorer&) = delete;

  /// For LocalServer. To be called on one thread, together with tick().
  void answer(const PageRequest& request, const SendReply& send);
  /// Looks at the files, and answers whoever has waited long. To be called now and then.
  void tick();
  /// Stops what runs and lets go of all that waits: after that nothing is answered.
  void end();

private:
  struct Waiting {
    long since;
    std::chrono::steady_clock::time_point until;
    SendReply send;
  };
  struct Watched {
    ExploredModel model;                   ///< only the queue's thread uses it, once it runs
    std::string state;                     ///< JSON of the model in the answer to "state"; guarded by the mutex
    FileWatch watch;                       ///< only tick()'s thread uses it
    bool is_reading = false;               ///< guarded by the mutex
    std::vector<std::string> files_read{}; ///< by a reading that has ended; guarded by the mutex
    bool has_read = false;                 ///< those are to be watched now; guarded by the mutex
    std::vector<std::string> watched{};    ///< what `watch` looks at
  };

  void read_again(std::size_t k);
  void answer_state(const std::string& query, const SendReply& send);
  void answer_post(const PageRequest& request, const SendReply& send);
  void answer_report(const std::string& query, const SendReply& send);
  void do_later(WorkQueue::Urgency urgency, const std::string& owner, const SendReply& send,
                std::function<PageReply(const WorkQueue::IsStale&)> work);
  [[nodiscard]] std::string state_text();

  std::vector<std::unique_ptr<Watched>> models_;
  std::mutex mutex_;
  long version_ = 1;             ///< guarded by the mutex
  std::vector<Waiting> waiting_; ///< only tick()'s thread uses it
  std::unique_ptr<WorkQueue> queue_;
};

} // namespace steplap
