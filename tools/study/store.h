// What a study leaves behind: one SQLite file with the study, the models, every sample and every finding.
//
// Samples are numbered from 1 in the order in which the study asks for them and are written in transactions, so that
// those in the file are always the first so many. One process writes. What is opened is looked at as a whole: a store
// that is damaged is refused (store_check.cpp).
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/io/input_files.h"
#include "tools/study/finding.h"
#include "tools/study/scene.h"

struct sqlite3;
struct sqlite3_stmt;

namespace steplap::study {

/// run: goes on with what is there, unless the study has changed; changed: even then, with those samples that are the
/// same; restart: drops what is there.
enum class StoreMode { run, changed, restart };

/// The store cannot be used: its message says why and what helps. Exit code 2.
class StoreError : public FileError {
public:
  /// `helps`: the modes in which the store could be used all the same.
  StoreError(std::string path, const std::string& message, std::vector<StoreMode> helps = {})
      : FileError(std::move(path), message), helps_(std::move(helps)) {}

  /// Modes in which the store could be used all the same.
  [[nodiscard]] const std::vector<StoreMode>& helps() const { return helps_; }

private:
  std::vector<StoreMode> helps_;
};

/// What a store holds besides samples.
struct StoreIdentity {
  std::string version; ///< of the program
  std::string study;   ///< text of the study file, with what it extends
  std::string kind;
  std::string scene;                           ///< all that a sample's numbers depend on: models, variables, responses, limit states
  std::vector<std::string> variables, numbers; ///< names of columns
  bool has_curves = false;                     ///< every sample has the values of its run at measured times
  std::vector<InputFile> files{};              ///< all that the study and its models were read from
};
[[nodiscard]] StoreIdentity identity_of(const LoadedStudy& loaded);

struct StoredSample {
  long number = 0;
  std::vector<double> values;
  Outcome outcome;
};

class Store {
public:
  /// run: makes the file if there is none; one of another study is refused (StoreError).
  Store(const std::string& path, const StoreIdentity& identity, StoreMode mode);
  /// For reading what is there, whatever it is of.
  explicit Store(const std::string& path);
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;
  ~Store();

  [[nodiscard]] const StoreIdentity& identity() const { return identity_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] long size() const { return size_; } ///< samples
  /// The study was changed, and not ended since: some samples may be of what it was before.
  [[nodiscard]] bool may_hold_others() { return !setting("changed").empty(); }
  /// Rows number first … first + count − 1, all there.
  void read(long first, long count, std::vector<StoredSample>& rows);
  /// On the disk within half a second, or with the next call of append(), note() or flush() after that.
  void append(const StoredSample* rows, std::size_t count);
  void flush();
  /// Takes out all samples from `number` on.
  void forget_from(long number);
  /// An estimate as it grew: `place` counts them within the study.
  void note(long place, const Finding& finding);
  /// Measured records beside what was found to fit them.
  struct CurvePoint {
    std::string history;
    double t = 0.0, measured = 0.0, fitted = 0.0; ///< s; in the unit of the channel
  };
  void set_histories(const std::vector<CurvePoint>& points);
  [[nodiscard]] std::vector<CurvePoint> histories(); ///< empty if there are none
  void set_findings(const std::vector<Finding>& findings, const std::vector<std::string>& notes, const std::string& standing);
  [[nodiscard]] std::vector<Finding> findings();
  [[nodiscard]] std::vector<Finding> growth();
  [[nodiscard]] std::vector<std::string> notes();
  [[nodiscard]] std::string setting(const std::string& key); ///< "" if there is none
  /// Keeps what report_about.h tells of the study, for the page; not part of what the store is of.
  void describe(const std::string& about);
  /// What is read from now on is of one instant, whatever another process writes.
  void hold();
  /// Of the i-th number: how many samples have a value; the one at a place when they are sorted, from 0.
  [[nodiscard]] long count_of(std::size_t i);
  [[nodiscard]] double order_statistic(std::size_t i, long place);
  /// Counts of statuses with their most frequent reasons: status, reason, count, first sample.
  struct Reason {
    std::string status, reason;
    long count = 0, first = 0;
  };
  [[nodiscard]] std::vector<Reason> reasons();

private:
  Store() = default; ///< the others begin with it: what they have opened is closed if they throw
  struct Statement;
  void open(const std::string& path, bool is_writing);
  bool is_cut_off();
  void lock();
  [[nodiscard]] bool is_empty();
  [[nodiscard]] long pragma(const char* name);
  void check_kind();
  void create(const StoreIdentity& identity);
  void execute(const std::string& sql);
  void begin();
  void commit_if_due();
  void set(const std::string& key, const std::string& value);
  void read_identity();
  void read_curves(long first, std::vector<StoredSample>& rows);
  void put(const std::string& table, long place, const Finding& finding);
  [[nodiscard]] std::vector<Finding> all_of(const std::string& table);
  [[nodiscard]] bool is_in_transaction() const;
  void end_reading() noexcept;
  [[noreturn]] void fail(const std::string& doing);
  [[noreturn]] void damaged(const std::string& why) const;
  [[nodiscard]] SampleStatus status_of(long status) const;
  static long fingerprint_of(const std::string& key, const std::string& value);
  static long fingerprint_of(const std::string& table, long place, const Finding& finding);
  static long fingerprint_of(long place, const CurvePoint& point);
  static std::string counts_text(std::size_t findings, std::size_t notes);
  static std::string files_text(const StoreIdentity& identity);
  [[nodiscard]] std::string changed_files(const StoreIdentity& now);
  void put_batch(const StoredSample* rows, std::size_t count);
  [[nodiscard]] long begin_of_batch(long number);
  void check();
  void check_pages();
  void check_settings();
  void check_samples();
  [[nodiscard]] std::string sample_columns() const;

  std::string path_;
  sqlite3* database_ = nullptr;
  int lock_file_ = -1;
  StoreIdentity identity_;
  long size_ = 0;
  bool is_open_ = false;   ///< a transaction is
  double committed_ = 0.0; ///< when the last one ended, s
};

} // namespace steplap::study
