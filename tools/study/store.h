// Store of a study: one SQLite file with the study, the models, every sample and every finding.
//
// Samples are numbered from 1 in the order of requests and are written in transactions, so the file always contains a complete initial
// sequence. Only one process writes. Opening a store checks all of it; a damaged store is rejected (store_check.cpp).
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/io/input_files.h"
#include "tools/study/finding.h"
#include "tools/study/sample_simulator.h"

struct sqlite3;
struct sqlite3_stmt;

namespace steplap::study {

/// Treatment of an existing store. run: continue, unless the study has changed; changed: continue even then, with the samples that remain
/// valid; restart: delete all samples.
enum class StoreMode { run, changed, restart };

/// Thrown if the store cannot be used, with reason and remedy. Exit code 2.
class StoreError : public FileError {
public:
  /// `helps` are the modes in which the store could still be used.
  StoreError(std::string path, const std::string& message, std::vector<StoreMode> helps = {})
      : FileError(std::move(path), message), helps_(std::move(helps)) {}

  /// Returns the modes in which the store could still be used.
  [[nodiscard]] const std::vector<StoreMode>& helps() const { return helps_; }

private:
  std::vector<StoreMode> helps_;
};

/// Identity of a study in a store.
struct StoreIdentity {
  std::string version; ///< program version
  std::string study;   ///< text of the study file, including extended files
  std::string kind;
  std::string scene;                           ///< everything that determines a sample's numbers: models, variables, responses, limit
                                               ///< states
  std::vector<std::string> variables, numbers; ///< column names
  bool has_curves = false;                     ///< samples contain the run's values at measured times
  std::vector<InputFile> files{};              ///< all files from which study and models were read
};
[[nodiscard]] StoreIdentity identity_of(const LoadedStudy& loaded);

/// A sample in the store.
struct StoredSample {
  long number = 0;
  std::vector<double> values;
  Outcome outcome;
};

/// An open store.
class Store {
public:
  /// Opens a store for a study, or creates it. A store of another study is rejected (StoreError), depending on `mode`.
  Store(const std::string& path, const StoreIdentity& identity, StoreMode mode);
  /// Opens a store for reading, whatever study it contains.
  explicit Store(const std::string& path);
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;
  ~Store();

  [[nodiscard]] const StoreIdentity& identity() const { return identity_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] long size() const { return size_; } ///< number of samples
  /// Returns true if the study was changed and has not been completed since: some samples may belong to the earlier version.
  [[nodiscard]] bool may_hold_others() { return !setting("changed").empty(); }
  /// Reads rows first … first + count − 1, which must exist.
  void read(long first, long count, std::vector<StoredSample>& rows);
  /// Appends samples. They are on disk after half a second, or at the next append(), note() or flush() after that.
  void append(const StoredSample* rows, std::size_t count);
  void flush();
  /// Deletes all samples from `number` on.
  void forget_from(long number);
  /// Stores an intermediate estimate with its consecutive number `place`.
  void note(long place, const Finding& finding);
  /// Point of a measured record with the fitted value.
  struct CurvePoint {
    std::string history;
    double t = 0.0, measured = 0.0, fitted = 0.0; ///< s; in the unit of the channel
  };
  /// Replaces the measured records with their fitted values.
  void set_histories(const std::vector<CurvePoint>& points);
  [[nodiscard]] std::vector<CurvePoint> histories(); ///< empty if there are none
  /// Replaces findings, notes and standing.
  void set_findings(const std::vector<Finding>& findings, const std::vector<std::string>& notes, const std::string& standing);
  [[nodiscard]] std::vector<Finding> findings();
  /// Returns the intermediate estimates.
  [[nodiscard]] std::vector<Finding> growth();
  [[nodiscard]] std::vector<std::string> notes();
  [[nodiscard]] std::string setting(const std::string& key); ///< "" if it does not exist
  /// Stores the description made by report_about.h. It is not part of the identity.
  void describe(const std::string& about);
  /// Starts a read transaction: later reads see the present contents, whatever another process writes.
  void hold();
  /// Returns how many samples have a value for number i. Below: the value at position `place`, from 0, in sorted order.
  [[nodiscard]] long count_of(std::size_t i);
  [[nodiscard]] double order_statistic(std::size_t i, long place);
  /// Frequency of a status with its most frequent reason and the first sample.
  struct Reason {
    std::string status, reason;
    long count = 0, first = 0;
  };
  [[nodiscard]] std::vector<Reason> reasons();

private:
  Store() = default; ///< delegated to by the others, so that open files are closed if they throw
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
  bool is_open_ = false;   ///< true within a transaction
  double committed_ = 0.0; ///< time of the last commit, s
};

} // namespace steplap::study
