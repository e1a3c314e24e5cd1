// Server of `steplap explore`: runs models, computes maps, saves changes and watches files.
//
// Paths after the token, with their replies. All data are JSON; numbers are SI.
//
//   ""               the page
//   page.js page.css its script and style
//   state?since=N    GET   the models with their sliders and errors: at once if the version is not N, otherwise when it changes or after
//                          a timeout
//   run              POST  {"model", "values": {path: number}, "page", "is_settled"}: {"version", "data": report_data() of the run}
//                          or {"errors"} or {"is_superseded": true}
//   cells            POST  {"model", "values", "x", "y", "cells": [[x, y], …]}: {"cells": [{"verdict", "shares": {name: share}} or {"error"}, …]},
//                          fewer than requested if a more urgent request arrived or time is over
//   save             POST  {"model", "values", "name"}: {"file"} or {"errors"}
//   report?model=K&values={…}  GET  the page of that run
//
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

/// Answers the requests of pages. Runs are computed on a separate thread.
class Explorer {
public:
  static constexpr double k_map_seconds = 0.2;         ///< computing time for one map request, s
  static constexpr std::size_t k_most_cells = 400;     ///< largest number of cells in one map request
  static constexpr std::size_t k_drag_budget = 300000; ///< size of the curves in a reply, bytes
  static constexpr int k_longest_wait = 20;            ///< timeout of a request for the state, s

  /// Reads the models. Throws ModelError with the errors of all.
  Explorer(const std::vector<std::string>& paths, const std::vector<std::string>& overrides);
  ~Explorer();
  Explorer(const Explorer&) = delete;
  Explorer& operator=(const Explorer&) = delete;

  /// Answers a request from LocalServer. Must be called on the same thread as tick().
  void answer(const PageRequest& request, const SendReply& send);
  /// Checks the files for changes and answers requests that have timed out. Must be called regularly.
  void tick();
  /// Stops the current run and discards all waiting requests. No request is answered afterwards.
  void end();

private:
  struct WaitingRequest {
    long since;
    std::chrono::steady_clock::time_point until;
    std::shared_ptr<const std::atomic<bool>> is_gone; ///< true when the client has closed the connection
    SendReply send;
  };
  struct WatchedModel {
    ExploredModel model;                   ///< used only by the worker thread once it runs
    std::string state;                     ///< JSON of the model in replies to "state"; guarded by the mutex
    FileWatch watch;                       ///< used only by the thread of tick()
    bool is_reading = false;               ///< true while the worker reads the file; guarded by the mutex
    std::vector<std::string> files_read{}; ///< files of the last completed reading; guarded by the mutex
    bool has_read = false;                 ///< true if `files_read` has not been passed to `watch` yet; guarded by the mutex
    std::vector<std::string> watched{};    ///< files that `watch` observes
  };

  void read_again(std::size_t k);
  void answer_state(const PageRequest& request, const SendReply& send);
  void answer_post(const PageRequest& request, const SendReply& send);
  void answer_report(const PageRequest& request, const SendReply& send);
  void do_later(WorkQueue::Urgency urgency, const std::string& owner, const PageRequest& request, const SendReply& send,
                std::function<PageReply(const WorkQueue::IsStale&)> work);
  [[nodiscard]] std::string state_text();

  std::vector<std::unique_ptr<WatchedModel>> models_;
  std::mutex mutex_;
  long version_ = 1;                    ///< version of the state, which increases with every change; guarded by the mutex
  std::vector<WaitingRequest> waiting_; ///< used only by the thread of tick()
  std::unique_ptr<WorkQueue> queue_;
};

} // namespace steplap
